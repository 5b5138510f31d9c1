// Reads bake.json, which is untrusted.
#include <fmt/format.h>

#include <charconv>
#include <map>
#include <set>

#include "bake/write/bake_fields.h"
#include "bake/write/manifest.h"
#include "bake/write/page_files.h"
#include "core/storage/layout_text.h"
#include "io/commit_journal.h"
#include "io/read_file.h"
#include "lobelia/storage.h"

namespace lobelia {
namespace {

constexpr std::uint64_t k_largest_side = 65536, k_most_pages = 4096, k_most_objects = 1u << 24, k_most_textures = 65536,
                        k_most_warnings = 4096, k_most_files = std::uint64_t{1} << 20;

std::uint64_t hexadecimal(const JsonPlace& place, std::size_t digits) {
    const std::string text = place.text();
    std::uint64_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value, 16);
    if (text.size() != digits || error != std::errc() || end != text.data() + text.size())
        place.refuse(fmt::format("not {} hexadecimal digits", digits));
    return value;
}

void read_scene(const JsonPlace& scene, Manifest& m) {
    m.scene_name = scene.at("name").text();
    m.scene_hash = hexadecimal(scene.at("hash"), 16);
    if (const auto file = scene.find("file")) m.scene = file->file_name();
    if (const auto file = scene.find("environment")) m.environment = file->file_name();
}

void read_codec(const JsonPlace& codec, Manifest& m) {
    m.options.frame = static_cast<Frame>(codec.at("frame").one_of(k_frame_names));
    const auto stated = codec.at("coefficients").whole(0, k_any_u32);
    m.options.codec = codec.at("name").text();
    // No codec: irradiance at the shading normal alone.
    if (m.options.codec.empty()) {
        if (stated != 0) codec.at("coefficients").refuse("there is no codec, so there can be no coefficients");
        return;
    }
    const auto name = parse_codec_name(m.options.codec);
    if (!name) codec.at("name").refuse(name.error().message);
    const auto basis = make_basis(name->basis);
    if (!basis) codec.at("name").refuse(basis.error().message);
    const auto evaluator = make_evaluator(name->evaluator, **basis);
    if (!evaluator) codec.at("name").refuse(evaluator.error().message);
    m.coefficients = (*basis)->size();
    if (stated != m.coefficients)
        codec.at("coefficients").refuse(fmt::format("{} has {} coefficients", name->basis, m.coefficients));
    if ((*basis)->domain() == Domain::hemisphere && m.options.frame != Frame::tangent)
        codec.at("frame").refuse(name->basis + " is a hemispherical basis, which requires the tangent frame");
}

/// The textures that storages make of the codec's coefficients, by storage and name.
class KnownTextures {
  public:
    explicit KnownTextures(const Manifest& m) {
        if (m.options.codec.empty()) return;
        // Good by now.
        const auto name = parse_codec_name(m.options.codec);
        traits_ = coefficient_traits(make_basis(name->basis).value());
    }
    [[nodiscard]] const TextureLayout::Texture& at(const JsonPlace& place) {
        const JsonPlace storage_place = place.at("storage"), name_place = place.at("name");
        if (!traits_) place.refuse("there is no codec, so there can be no textures");
        const auto& textures = of_storage(storage_place);
        const auto found = textures.find(name_place.text());
        if (found == textures.end()) name_place.refuse("no texture of the storage " + storage_place.text());
        return found->second;
    }

  private:
    using Textures = std::map<std::string, TextureLayout::Texture>;
    const Textures& of_storage(const JsonPlace& place) {
        const auto known = textures_.find(place.text());
        if (known != textures_.end()) return known->second;
        const auto storage = find_storages(std::array{place.text()}, *traits_);
        if (!storage) place.refuse(storage.error().message);
        Textures& textures = textures_[place.text()];
        for (auto& texture : storage->front()->layout(*traits_).textures) textures.emplace(texture.name, texture);
        return textures;
    }

    std::optional<CoefficientTraits> traits_;
    std::map<std::string, Textures> textures_;
};

TextureEntry read_texture(const JsonPlace& place, KnownTextures& known) {
    // The storage determines the content of the channels. Refuse other contents, so that later versions cannot misread
    // old files.
    const TextureLayout::Texture& layout = known.at(place);
    place.expect(nlohmann::json::parse(texture_json(layout)));
    const auto scale = static_cast<float>(place.at("scale").number_in(0x1p-149, 0x1p127));
    TextureEntry entry{place.at("storage").text(), place.at("file").file_name(), layout, scale};
    if (const auto layer = place.find("layer")) entry.layer = layer->whole(0, k_most_textures - 1);
    return entry;
}

PageEntry read_page_entry(const JsonPlace& place, KnownTextures& known) {
    PageEntry page{place.at("file").file_name(), {}, {}};
    for (const auto& texture : place.at("textures").list(k_most_textures))
        page.textures.push_back(read_texture(texture, known));
    if (const auto validity = place.find("validity")) page.validity = validity->file_name();
    return page;
}

void read_layout(const JsonPlace& layout, Manifest& m) {
    m.width = layout.at("width").whole(1, k_largest_side);
    m.height = layout.at("height").whole(1, k_largest_side);
    m.options.atlas.width = m.width;
    m.options.atlas.height = m.height;
    m.precision = static_cast<Precision>(layout.at("precision").one_of(k_precision_names));
    const auto names = page_channel_names(PageChannels{m.coefficients});
    const auto channels = layout.at("channels").list_of(names.size());
    for (std::size_t i = 0; i < names.size(); ++i)
        if (channels[i].text() != names[i]) channels[i].refuse(fmt::format("not \"{}\"", names[i]));
    KnownTextures known(m);
    for (const auto& page : layout.at("pages").list(k_most_pages)) m.pages.push_back(read_page_entry(page, known));
    if (m.pages.empty()) layout.at("pages").refuse("no pages");
}

Vec2 scaled_pair(const JsonPlace& place, const Manifest& m) {
    // Well within float32 once they are texels.
    constexpr double k_most = 1e30;
    const auto pair = place.list_of(2);
    return {static_cast<float>(pair[0].number_in(-k_most, k_most) * static_cast<double>(m.width)),
            static_cast<float>(pair[1].number_in(-k_most, k_most) * static_cast<double>(m.height))};
}

AtlasPlacement read_placement(const JsonPlace& object, const Manifest& m) {
    AtlasPlacement placement;
    const auto page = object.find("page");
    if (!page) return placement;
    placement.baked = true;
    placement.page = static_cast<std::uint32_t>(page->whole(0, m.pages.size() - 1));
    placement.scale = scaled_pair(object.at("uv_scale"), m);
    placement.offset = scaled_pair(object.at("uv_offset"), m);
    const auto texels = object.at("texels").list_of(4);
    const auto side = [&](std::size_t i, std::size_t most) { return static_cast<int>(texels[i].whole(0, most)); };
    placement.texels = {side(0, m.width), side(1, m.height), side(2, m.width), side(3, m.height)};
    return placement;
}

void refuse_repeated_files(const JsonPlace& top, const Manifest& m) {
    std::set<std::string> seen;
    const auto add = [&](const std::string& file) {
        if (!seen.insert(file).second) top.refuse(fmt::format("the file {} is named twice", file));
    };
    for (const auto& page : m.pages) {
        add(page.file);
        // Layers of an array texture share its file.
        std::map<std::string, std::set<std::size_t>> layers;
        for (const auto& texture : page.textures) {
            if (!texture.layer || layers.count(texture.file) == 0) add(texture.file);
            if (texture.layer && !layers[texture.file].insert(*texture.layer).second)
                top.refuse(fmt::format("layer {} of the file {} is named twice", *texture.layer, texture.file));
        }
        if (page.validity) add(*page.validity);
    }
    if (m.scene) add(*m.scene);
    if (m.environment) add(*m.environment);
    if (m.probes) add(*m.probes);
}

FileEntry read_file_entry(const JsonPlace& place) {
    FileEntry entry{place.at("file").file_name(), place.at("size").whole(0, k_any_u64 >> 1), 0};
    entry.crc32 = static_cast<std::uint32_t>(hexadecimal(place.at("crc32"), 8));
    return entry;
}

Manifest read_all(const JsonPlace& top) {
    if (!top.find("lobelia_bake")) top.refuse("no \"lobelia_bake\" version; is it from `lobelia bake`?");
    const auto version = top.at("lobelia_bake").whole(0, k_any_u32);
    if (version < k_oldest_bake_version || version > k_bake_version)
        top.at("lobelia_bake")
            .refuse(fmt::format("version {}, but this program reads versions {} to {}", version, k_oldest_bake_version,
                                k_bake_version));
    Manifest m;
    m.program = top.at("program").text();
    read_scene(top.at("scene"), m);
    if (const auto warnings = top.find("warnings"))
        for (const auto& warning : warnings->list(k_most_warnings)) m.warnings.push_back(warning.text());
    read_codec(top.at("codec"), m);
    read_layout(top.at("layout"), m);
    for (const auto& object : top.at("objects").list(k_most_objects))
        m.objects.push_back({object.at("name").text(), read_placement(object, m)});
    if (const auto finish = top.find("finish"))
        for (const auto& step : finish->list(k_most_warnings)) m.finish.push_back(step.text());
    if (const auto probes = top.find("probes")) m.probes = probes->file_name();
    if (const auto files = top.find("files"))
        for (const auto& file : files->list(k_most_files)) m.files.push_back(read_file_entry(file));
    JsonFieldReader(top).group("options", m.options);
    JsonFieldReader(top).group("statistics", m.statistics);
    refuse_repeated_files(top, m);
    return m;
}

}  // namespace

Result<Manifest> manifest_from_json(std::string_view text, const std::string& name) {
    return read_json(text, name, read_all);
}

std::filesystem::path bake_folder(const std::filesystem::path& path) {
    std::error_code code;
    return std::filesystem::is_directory(path, code) ? path : path.parent_path();
}

Result<ManifestText> read_manifest_text(const std::filesystem::path& path) {
    // A caller who names the file itself may name a link; what lies in a folder must not be one.
    std::error_code code;
    const bool is_folder = std::filesystem::is_directory(path, code);
    const std::string name = is_folder ? k_manifest_name : path.filename().string();
    const auto folder = CommittedFolder::open(bake_folder(path));
    if (!folder) return folder.error();
    const auto file = InputFile::open(
        folder->path(name), {.most_bytes = std::uint64_t{1} << 30,
                             .links = is_folder ? InputOptions::Links::refused : InputOptions::Links::followed});
    if (!file) return file.error();
    auto text = read_text(*file);
    return text ? Result<ManifestText>({*std::move(text), (bake_folder(path) / name).string()}) : text.error();
}

Result<Manifest> read_manifest(const std::filesystem::path& path) {
    const auto text = read_manifest_text(path);
    return text ? manifest_from_json(text->text, text->name) : text.error();
}

}  // namespace lobelia
