// JPEG by libjpeg-turbo. Its warnings about data are errors here, and so are undefined tables, for which it would use
// defaults, and missing scans, for which it would return grey. References are to ITU-T T.81.
#include <fmt/format.h>

#include <cstdio>
// jpeglib.h needs FILE and size_t before it.
#include <jerror.h>
#include <jpeglib.h>

#include "io/decode_picture.h"
#include "io/escape.h"

namespace lobelia::io {

namespace {

/// State of libjpeg and of the bytes that it reads.
struct JpegReader {
    explicit JpegReader(std::span<const std::byte> bytes) {
        source.next_input_byte = reinterpret_cast<const JOCTET*>(bytes.data());
        source.bytes_in_buffer = bytes.size();
        codec.client_data = this;
    }
    JpegReader(const JpegReader&) = delete;
    JpegReader& operator=(const JpegReader&) = delete;
    ~JpegReader() { jpeg_destroy_decompress(&codec); }

    jpeg_decompress_struct codec{};
    jpeg_error_mgr errors{};
    jpeg_source_mgr source{};
    Escape escape;
    int scans = 0;
    std::array<bool, MAX_COMPONENTS> stored{};  ///< components of which the scans so far have the DC coefficients
};

JpegReader& reader_of(j_common_ptr codec) { return *static_cast<JpegReader*>(codec->client_data); }
JpegReader& reader_of(j_decompress_ptr codec) { return *static_cast<JpegReader*>(codec->client_data); }

[[noreturn]] void leave(j_common_ptr codec) {
    char text[JMSG_LENGTH_MAX];
    codec->err->format_message(codec, text);
    reader_of(codec).escape.leave(text);
}

/// Negative levels are warnings: corrupt data, but for one about the version of JFIF.
void take_message(j_common_ptr codec, int level) {
    if (level < 0 && codec->err->msg_code != JWRN_JFIF_MAJOR) leave(codec);
}

void ignore_message(j_common_ptr) {}
void ignore_step(j_decompress_ptr) {}

boolean refuse_to_fill(j_decompress_ptr codec) { reader_of(codec).escape.leave("the file ends too early"); }

void skip_bytes(j_decompress_ptr codec, long count) {
    if (count <= 0) return;
    if (static_cast<std::size_t>(count) > codec->src->bytes_in_buffer) refuse_to_fill(codec);
    codec->src->next_input_byte += count;
    codec->src->bytes_in_buffer -= static_cast<std::size_t>(count);
}

/// Reads all up to the first scan, and chooses RGBA (or CMYK, which libjpeg does not convert).
void read_header(JpegReader& reader) {
    reader.codec.err = jpeg_std_error(&reader.errors);
    reader.errors.error_exit = leave;
    reader.errors.emit_message = take_message;
    reader.errors.output_message = ignore_message;
    jpeg_create_decompress(&reader.codec);
    reader.source.init_source = reader.source.term_source = ignore_step;
    reader.source.fill_input_buffer = refuse_to_fill;
    reader.source.skip_input_data = skip_bytes;
    reader.source.resync_to_restart = jpeg_resync_to_restart;
    reader.codec.src = &reader.source;
    jpeg_read_header(&reader.codec, TRUE);
    const J_COLOR_SPACE colours = reader.codec.jpeg_color_space;
    if (colours == JCS_UNKNOWN) reader.escape.leave("its colours are neither grey, nor RGB, YCbCr, CMYK or YCCK");
    reader.codec.out_color_space = colours == JCS_CMYK || colours == JCS_YCCK ? JCS_CMYK : JCS_EXT_RGBA;
}

/// Counts a scan, and notes the components whose DC coefficients it has.
void take_scan(JpegReader& reader) {
    // A file of many small scans would be decoded for hours; encoders write about ten.
    constexpr int k_most_scans = 100;
    if (++reader.scans > k_most_scans) reader.escape.leave("more than 100 scans");
    if (reader.codec.Ss != 0) return;
    for (int i = 0; i < reader.codec.comps_in_scan; ++i)
        reader.stored[static_cast<std::size_t>(reader.codec.cur_comp_info[i]->component_index)] = true;
}

/// Requires the Huffman tables of the first scan (T.81, B.2.3), as libjpeg would put defaults in their place.
void require_tables(JpegReader& reader) {
    const jpeg_decompress_struct& codec = reader.codec;
    if (codec.arith_code || codec.progressive_mode) return;
    const auto exists = [](int table) { return table >= 0 && table < NUM_HUFF_TBLS; };
    for (int i = 0; i < codec.comps_in_scan; ++i) {
        const jpeg_component_info& component = *codec.cur_comp_info[i];
        // The file's numbers, up to 15.
        if (!exists(component.dc_tbl_no) || !exists(component.ac_tbl_no) ||
            codec.dc_huff_tbl_ptrs[component.dc_tbl_no] == nullptr ||
            codec.ac_huff_tbl_ptrs[component.ac_tbl_no] == nullptr)
            reader.escape.leave("a scan names a Huffman table that was not defined");
    }
}

/// Starts decompression without default Huffman tables: later scans that name one are refused by libjpeg.
void start(JpegReader& reader) {
    jpeg_decompress_struct& codec = reader.codec;
    require_tables(reader);
    bool has_dc[NUM_HUFF_TBLS], has_ac[NUM_HUFF_TBLS];
    for (int i = 0; i < NUM_HUFF_TBLS; ++i) {
        has_dc[i] = codec.dc_huff_tbl_ptrs[i] != nullptr;
        has_ac[i] = codec.ac_huff_tbl_ptrs[i] != nullptr;
    }
    codec.do_block_smoothing = FALSE;
    codec.buffered_image = jpeg_has_multiple_scans(&codec);
    jpeg_start_decompress(&codec);
    for (int i = 0; i < NUM_HUFF_TBLS; ++i) {
        if (!has_dc[i]) codec.dc_huff_tbl_ptrs[i] = nullptr;
        if (!has_ac[i]) codec.ac_huff_tbl_ptrs[i] = nullptr;
    }
}

/// Reads all scans of a picture that has several, and requires one for each component.
void read_scans(JpegReader& reader) {
    take_scan(reader);
    for (int event = 0; event != JPEG_REACHED_EOI;) {
        event = jpeg_consume_input(&reader.codec);
        if (event == JPEG_REACHED_SOS) take_scan(reader);
    }
    for (int i = 0; i < reader.codec.num_components; ++i)
        if (!reader.stored[static_cast<std::size_t>(i)]) reader.escape.leave("a component without a scan");
}

void read_rows(JpegReader& reader, Rgba8* texels) {
    jpeg_decompress_struct& codec = reader.codec;
    start(reader);
    if (codec.buffered_image) {
        read_scans(reader);
        jpeg_start_output(&codec, codec.input_scan_number);
    }
    while (codec.output_scanline < codec.output_height) {
        JSAMPROW row = reinterpret_cast<JSAMPROW>(texels + std::size_t{codec.output_scanline} * codec.output_width);
        jpeg_read_scanlines(&codec, &row, 1);
    }
    if (codec.buffered_image) jpeg_finish_output(&codec);
    jpeg_finish_decompress(&codec);
}

/// Converts inks to red, green and blue without a colour profile. Adobe's files store 255 for no ink, others 0.
void convert_inks(std::vector<Rgba8>& texels, bool inverted) {
    for (Rgba8& texel : texels) {
        const unsigned flip = inverted ? 0 : 255;
        const unsigned black = texel[3] ^ flip;
        for (std::size_t c = 0; c < 3; ++c)
            texel[c] = static_cast<std::uint8_t>(((texel[c] ^ flip) * black + 127) / 255);
        texel[3] = 255;
    }
}

}  // namespace

Result<Picture> decode_jpeg(std::span<const std::byte> bytes, std::string_view name, const PictureOptions& options) {
    JpegReader reader(bytes);
    const auto damaged = [&] {
        return Error{fmt::format("{}: damaged or unsupported JPEG: {}, at byte {} of {}", name, reader.escape.message(),
                                 bytes.size() - reader.source.bytes_in_buffer, bytes.size())};
    };
    if (!reader.escape.run([&] { read_header(reader); })) return damaged();

    // Check the size. A block of 64 equal pixels takes at least one bit.
    const std::int64_t width = reader.codec.image_width, height = reader.codec.image_height;
    const Status size = check_picture_size(name, width, height, bytes.size(), 64 * 8, options);
    if (!size) return size.error();

    // Decode.
    auto texels = filled<Rgba8>(static_cast<std::size_t>(width * height), options);
    if (!reader.escape.run([&] { read_rows(reader, texels.data()); })) return damaged();
    if (reader.codec.out_color_space == JCS_CMYK) convert_inks(texels, reader.codec.saw_Adobe_marker != FALSE);
    return Picture{static_cast<std::size_t>(width), static_cast<std::size_t>(height), std::move(texels)};
}

}  // namespace lobelia::io
