// A parsed glTF file: its JSON, checked on access, and its buffers as bytes.
//
// Code in src/scene/gltf throws every fault of a file as JsonRefusal; read_gltf turns it into an Error.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>

#include "core/stop.h"
#include "io/json.h"
#include "scene/gltf/resources.h"

namespace lobelia::gltf {

using Bytes = std::span<const std::byte>;

struct Document {
    Document(JsonDocument parsed, Resources from, const GltfReadOptions& with)
        : json(std::move(parsed)), resources(std::move(from)), options(with) {}

    JsonDocument json;
    Resources resources;
    GltfReadOptions options;

    /// The entries of the file's arrays; each is an object.
    std::vector<JsonPlace> accessors, buffer_views, cameras, images, lights, materials, meshes, nodes, samplers, scenes,
        skins, textures;
    std::vector<Bytes> buffers;

    std::vector<std::string> warnings;
    std::size_t more_warnings = 0;  ///< number of warnings not kept
    /// Indices of sparse accessors, checked and read once each.
    std::map<std::size_t, std::shared_ptr<const std::vector<std::uint32_t>>> sparse_indices;

    std::size_t file_bytes = 0;                ///< size of the file itself
    std::size_t kept_bytes = 0, elements = 0;  ///< memory of the scene and elements read so far

    /// Counts memory that the scene keeps, before it is allocated; refuses `place` beyond
    /// GltfReadOptions::scene_memory.
    void keep(const JsonPlace& place, std::size_t count, std::size_t bytes_each);
    /// Counts elements that are about to be read; refuses `place` beyond the limit. Throws Stopped if that is asked
    /// for.
    void work(const JsonPlace& place, std::size_t count);
    /// Calls visit(i) for each i below `count`, and counts them as work in between.
    template <class Visit>
    void for_each(const JsonPlace& place, std::size_t count, const Visit& visit) {
        constexpr std::size_t k_block = 65536;
        for (std::size_t begin = 0; begin < count; begin += k_block) {
            const std::size_t end = std::min(count, begin + k_block);
            work(place, end - begin);
            for (std::size_t i = begin; i < end; ++i) visit(i);
        }
    }
    [[nodiscard]] StopFlag stop() const { return options.stop; }
    [[nodiscard]] std::size_t scene_memory() const;

    [[noreturn]] void refuse(std::string_view place, std::string_view problem) const {
        throw JsonRefusal(fmt::format("{}: {}: {}", json.file(), place, problem));
    }
    void warn(std::string_view place, std::string_view what);
    void warn(const JsonPlace& place, std::string_view what);
};

/// The two parts of a file; text files have no binary part.
struct Container {
    std::string_view json;
    std::optional<Bytes> binary;
};
[[nodiscard]] Container split(Bytes bytes, std::string_view name);

/// The entries of a list of objects; none where it is missing.
[[nodiscard]] std::vector<JsonPlace> objects(const JsonPlace& parent, const char* key);

/// Parses the file and fetches its buffers. `bytes` must outlive the document.
[[nodiscard]] Document open_document(Bytes bytes, const std::string& name, const ResourceReader& resources,
                                     const GltfReadOptions& options);

/// Returns the bytes of the buffer view with this index.
[[nodiscard]] Bytes view_bytes(const Document& document, const JsonPlace& index);

/// Returns the message about data that only an extension could decompress.
[[nodiscard]] std::string compressed(std::string_view extension);

/// Returns the member "name"; empty if it is missing. Very long names are truncated, because they are copied for each
/// instance.
[[nodiscard]] std::string name_of(const JsonPlace& object);

/// Returns the extension of an object, or nothing.
[[nodiscard]] std::optional<JsonPlace> extension(const JsonPlace& object, const char* name);

/// Returns a number that may be missing.
[[nodiscard]] double number_or(const JsonPlace& object, const char* key, double otherwise);

/// Returns a whole number below `count`, such as an index into an array of that size.
[[nodiscard]] std::size_t index_below(const JsonPlace& value, std::size_t count);
/// Returns the same for a member that may be missing.
[[nodiscard]] std::optional<std::size_t> find_index(const JsonPlace& object, const char* key, std::size_t count);

/// Returns a whole number of fewer than 32 bits.
[[nodiscard]] inline std::size_t whole(const JsonPlace& value) { return value.whole(0, 0x7fffffff); }

/// The largest accepted emission, radiant intensity or irradiance, as for the texels of environments: sums of several
/// and their squares stay finite in float.
inline constexpr double k_most_light = 1e15;

/// Returns three numbers in [0, k_most_light] times a scale; refuses `place` if the product is out of this range.
[[nodiscard]] Rgb light_amount(const JsonPlace& place, const std::array<double, 3>& color, double scale,
                               std::string_view what);

/// Flag in a mesh's extras: its TEXCOORD_1 only fills a gap and does not hold lightmap UVs.
inline constexpr const char* k_no_lightmap = "lobelia_no_lightmap";

}  // namespace lobelia::gltf
