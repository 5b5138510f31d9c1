// bake.json, written.
#include <fmt/format.h>

#include "bake/write/bake_fields.h"
#include "bake/write/manifest.h"
#include "bake/write/page_files.h"
#include "core/storage/layout_text.h"
#include "lobelia/bases.h"
#include "scene/scene_hash.h"

namespace lobelia {
namespace {

using nlohmann::ordered_json;

constexpr const char* k_program_version = LOBELIA_VERSION;
constexpr int k_lightmap_extension_version = 1;

ordered_json or_null(const std::optional<std::string>& text) { return text ? ordered_json(*text) : ordered_json(); }

ordered_json to_json(const TextureEntry& texture) {
    ordered_json json = {{"storage", texture.storage}, {"file", texture.file}, {"scale", shortest(texture.scale)}};
    if (texture.layer) json["layer"] = *texture.layer;
    json.update(ordered_json::parse(texture_json(texture.layout)));
    return json;
}

ordered_json to_json(const FileEntry& entry) {
    return {{"file", entry.file}, {"size", entry.size}, {"crc32", fmt::format("{:08x}", entry.crc32)}};
}

ordered_json to_json(const PageEntry& page) {
    ordered_json textures = ordered_json::array();
    for (const auto& texture : page.textures) textures.push_back(to_json(texture));
    return {{"file", page.file}, {"textures", std::move(textures)}, {"validity", or_null(page.validity)}};
}

/// In double precision, page uv = uv_scale * uv + uv_offset gives back the placement exactly.
ordered_json to_json(const ObjectEntry& object, const Manifest& m) {
    const AtlasPlacement& p = object.placement;
    if (!p.baked) return {{"name", object.name}, {"page", nullptr}};
    const auto width = static_cast<double>(m.width), height = static_cast<double>(m.height);
    return {{"name", object.name},
            {"page", p.page},
            {"uv_scale", {p.scale.x / width, p.scale.y / height}},
            {"uv_offset", {p.offset.x / width, p.offset.y / height}},
            {"texels", {p.texels.x0, p.texels.y0, p.texels.x1, p.texels.y1}}};
}

/// Writes conventions for people; readers may rely on the version alone.
ordered_json conventions(const Manifest& m) {
    const bool tangent = m.options.frame == Frame::tangent;
    return {
        {"colour", "linear Rec. 709"},
        {"coefficients", "of radiance [W/(m^2 sr)]"},
        {"irradiance", "E [W/m^2], not divided by pi"},
        {"axes", "right-handed, y up, metres"},
        {"directions", tangent ? "tangent frame: rows x, y, z of the formula, z the shading normal" : "world frame"},
        {"tangent_frame", tangent ? ordered_json("frisvad-2012 about (2, 3, 6) / 7") : ordered_json()},
        {"uv", "(0, 0) at the top left, texel centres at + 0.5"},
        {"described_in", "docs/conventions.md and docs/bake-format.md of Lobelia"}};
}

ordered_json codec_json(const Manifest& m) {
    const CodecName name = m.options.codec.empty() ? CodecName{} : parse_codec_name(m.options.codec).value();
    ordered_json json = {
        {"name", m.options.codec},        {"basis", name.basis},
        {"encoder", name.encoder},        {"evaluator", name.evaluator},
        {"coefficients", m.coefficients}, {"frame", k_frame_names[static_cast<std::size_t>(m.options.frame)]}};
    if (m.options.codec.empty()) return json;

    // The axis and the sharpness of each lobe, for readers without shader code.
    ordered_json lobes = ordered_json::array();
    for (const Lobe& lobe : lobes_of(*make_basis(name.basis).value()))
        lobes.push_back({{"axis", {shortest(lobe.axis.x), shortest(lobe.axis.y), shortest(lobe.axis.z)}},
                         {"sharpness", shortest(lobe.sharpness)}});
    if (!lobes.empty()) json["lobes"] = std::move(lobes);
    return json;
}

ordered_json pages_json(const Manifest& m) {
    ordered_json pages = ordered_json::array();
    for (const auto& page : m.pages) pages.push_back(to_json(page));
    return pages;
}

/// Leaves out what is null, which glTF does not allow.
ordered_json without_nulls(const ordered_json& value) {
    if (!value.is_structured()) return value;
    ordered_json result = value.is_array() ? ordered_json::array() : ordered_json::object();
    for (const auto& [key, member] : value.items()) {
        if (member.is_null()) continue;
        if (value.is_array())
            result.push_back(without_nulls(member));
        else
            result[key] = without_nulls(member);
    }
    return result;
}

template <class T>
ordered_json all_fields(T value) {
    JsonFieldWriter writer;
    fields(writer, value);
    return std::move(writer.object);
}

}  // namespace

Manifest make_manifest(const Scene& scene, const Atlas& atlas, const BakeOptions& options) {
    Manifest m;
    m.program = k_program_version;
    m.scene_name = scene.name;
    m.scene_hash = scene_hash(scene);
    m.coefficients = options.codec.empty() ? 0 : make_codec(options.codec).value().basis().size();
    m.width = atlas.width();
    m.height = atlas.height();
    for (std::size_t i = 0; i < scene.objects.size(); ++i)
        m.objects.push_back({scene.objects[i].name, atlas.placements()[i]});
    m.options = options;
    return m;
}

std::string to_json_text(const Manifest& m) {
    ordered_json objects = ordered_json::array(), files = ordered_json::array();
    for (const auto& file : m.files) files.push_back(to_json(file));
    for (const auto& object : m.objects) objects.push_back(to_json(object, m));
    const ordered_json document = {{"lobelia_bake", k_bake_version},
                                   {"program", m.program},
                                   {"scene",
                                    {{"name", m.scene_name},
                                     {"hash", fmt::format("{:016x}", m.scene_hash)},
                                     {"file", or_null(m.scene)},
                                     {"environment", or_null(m.environment)}}},
                                   {"warnings", m.warnings},
                                   {"codec", codec_json(m)},
                                   {"conventions", conventions(m)},
                                   {"layout",
                                    {{"width", m.width},
                                     {"height", m.height},
                                     {"precision", k_precision_names[static_cast<std::size_t>(m.precision)]},
                                     {"channels", page_channel_names(PageChannels{m.coefficients})},
                                     {"pages", pages_json(m)}}},
                                   {"objects", std::move(objects)},
                                   {"probes", or_null(m.probes)},
                                   {"files", std::move(files)},
                                   {"options", all_fields(m.options)},
                                   {"finish", m.finish},
                                   {"statistics", all_fields(m.statistics)}};
    return json_text(document, 1) + "\n";
}

std::string lightmap_extension_text(const Manifest& m) {
    return json_text(without_nulls(ordered_json{{"version", k_lightmap_extension_version},
                                                {"manifest", k_manifest_name},
                                                {"texCoord", 1},
                                                {"codec", codec_json(m)},
                                                {"conventions", conventions(m)},
                                                {"width", m.width},
                                                {"height", m.height},
                                                {"pages", pages_json(m)},
                                                {"probes", or_null(m.probes)}}));
}

}  // namespace lobelia
