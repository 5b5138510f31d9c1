// Probes as two files: probes.json says what there is, probes.bin holds the coefficients.
#include "bake/write/probe_files.h"

#include <fmt/format.h>

#include <bit>
#include <cassert>
#include <cmath>
#include <nlohmann/json.hpp>

#include "io/json.h"
#include "io/read_file.h"
#include "lobelia/codec.h"

namespace lobelia {
namespace {

using nlohmann::ordered_json;

constexpr std::uint64_t k_most_visibility_side = 64;
constexpr std::uint64_t k_most_probes = 1u << 26, k_most_cells = 1u << 26, k_most_coefficients = 4096;
constexpr std::uintmax_t k_most_mebibytes = 16384;
static_assert(std::endian::native == std::endian::little, "files are little-endian");

ordered_json triple(Vec3 v) { return {shortest(v.x), shortest(v.y), shortest(v.z)}; }

ordered_json singles(const std::vector<float>& values) {
    ordered_json list = ordered_json::array();
    for (float value : values) list.push_back(shortest(value));
    return list;
}

ordered_json to_json(const ProbeCell& cell) {
    return {{"lowest", triple(cell.lowest)}, {"size", shortest(cell.size)}, {"corners", cell.corners}};
}

ProbeGrid read_grid(const JsonPlace& place, std::size_t probes) {
    ProbeGrid grid{{}, place.at("origin").vector(), place.at("spacing").vector()};
    const auto count = place.at("count").list_of(3);
    std::uint64_t product = 1;
    for (std::size_t k = 0; k < 3; ++k) {
        grid.count[k] = static_cast<std::uint32_t>(count[k].whole(1, k_most_probes));
        product *= grid.count[k];
        if (product > probes) break;
    }
    if (product != probes) place.at("count").refuse(fmt::format("it is not that of {} probes", probes));
    return grid;
}

ProbeCell read_cell(const JsonPlace& place, std::size_t probes) {
    ProbeCell cell{place.at("lowest").vector(), place.at("size").single(), {}};
    if (!(cell.size > 0)) place.at("size").refuse("not above 0");
    const auto corners = place.at("corners").list_of(8);
    for (std::size_t k = 0; k < 8; ++k) cell.corners[k] = static_cast<std::uint32_t>(corners[k].whole(0, probes - 1));
    return cell;
}

std::vector<float> read_shares(const JsonPlace& place, std::size_t size) {
    std::vector<float> shares;
    for (const auto& entry : place.list_of(size)) shares.push_back(static_cast<float>(entry.number_in(0, 1)));
    return shares;
}

void read_codec(const JsonPlace& top, ProbeSet& probes) {
    probes.codec = top.at("codec").text();
    const auto name = parse_codec_name(probes.codec);
    if (!name) top.at("codec").refuse(name.error().message);
    const auto basis = make_basis(name->basis);
    if (!basis) top.at("codec").refuse(basis.error().message);
    if ((*basis)->domain() != Domain::sphere) top.at("codec").refuse("not a basis over the sphere");
    probes.coefficients_per_probe = top.at("coefficients").whole(0, k_most_coefficients);
    if (probes.coefficients_per_probe != (*basis)->size())
        top.at("coefficients").refuse(fmt::format("{} has {} coefficients", name->basis, (*basis)->size()));
}

/// All but the coefficients, and the name of their file.
std::string read_description(const JsonPlace& top, ProbeSet& probes) {
    const auto version = top.at("lobelia_probes").whole(0, 0xffffffff);
    if (version != static_cast<std::uint64_t>(k_probes_version))
        top.at("lobelia_probes")
            .refuse(fmt::format("version {}, but this program reads version {}", version, k_probes_version));
    read_codec(top, probes);
    for (const auto& position : top.at("positions").list(k_most_probes)) probes.positions.push_back(position.vector());
    const std::size_t count = probes.size();
    if (count == 0) top.at("positions").refuse("no probes");
    if (top.at("count").whole(0, k_most_probes) != count) top.at("count").refuse(fmt::format("not {}", count));
    probes.validity = read_shares(top.at("validity"), count);
    probes.back_faces = read_shares(top.at("back_faces"), count);
    if (const auto grid = top.find("grid")) probes.grid = read_grid(*grid, count);
    for (const auto& cell : top.at("cells").list(k_most_cells)) probes.cells.push_back(read_cell(cell, count));
    return top.at("file").file_name();
}

/// Reads floats that are all there are in a file.
template <class T>
Status read_floats(const std::filesystem::path& path, std::size_t count, const std::string& what, std::vector<T>& out) {
    const auto bytes = read_text(path, k_most_mebibytes);
    if (!bytes) return bytes.error();
    if (bytes->size() != count * sizeof(float))
        return Error{
            fmt::format("{}: {} bytes, but {} take {}", path.string(), bytes->size(), what, count * sizeof(float))};
    out.resize(count * sizeof(float) / sizeof(T));
    std::memcpy(out.data(), bytes->data(), bytes->size());
    return Done{};
}

Status read_visibility(const std::filesystem::path& path, ProbeSet& probes) {
    const std::size_t texels = probes.size() * probes.visibility_side * probes.visibility_side;
    const std::string what =
        fmt::format("maps of {0} x {0} texels for {1} probes", probes.visibility_side, probes.size());
    if (Status status = read_floats(path, 2 * texels, what, probes.visibility); !status) return status;
    for (std::size_t i = 0; i < texels; ++i) {
        const auto [mean, square] = probes.visibility[i];
        if (!(mean >= 0 && square >= 0) || !std::isfinite(mean) || !std::isfinite(square))
            return Error{fmt::format("{}: texel {} is not a distance and its square", path.string(), i)};
    }
    return Done{};
}

Status read_coefficients(const std::filesystem::path& path, ProbeSet& probes) {
    const std::string what = fmt::format("{} probes of {} coefficients", probes.size(), probes.coefficients_per_probe);
    if (Status status = read_floats(path, 3 * probes.size() * probes.coefficients_per_probe, what, probes.coefficients);
        !status)
        return status;
    for (std::size_t i = 0; i < probes.coefficients.size(); ++i) {
        const Rgb c = probes.coefficients[i];
        if (!std::isfinite(c.r) || !std::isfinite(c.g) || !std::isfinite(c.b))
            return Error{fmt::format("{}: coefficient {} of probe {} is not finite", path.string(),
                                     i % probes.coefficients_per_probe, i / probes.coefficients_per_probe)};
    }
    return Done{};
}

}  // namespace

std::string to_json_text(const ProbeSet& probes, std::string_view binary_file, std::string_view visibility_file) {
    ordered_json visibility;
    if (!visibility_file.empty()) visibility = {{"file", visibility_file}, {"side", probes.visibility_side}};
    ordered_json positions = ordered_json::array(), cells = ordered_json::array(), grid;
    for (const Vec3& position : probes.positions) positions.push_back(triple(position));
    for (const ProbeCell& cell : probes.cells) cells.push_back(to_json(cell));
    if (probes.grid)
        grid = {{"count", probes.grid->count},
                {"origin", triple(probes.grid->origin)},
                {"spacing", triple(probes.grid->spacing)}};
    const ordered_json document = {{"lobelia_probes", k_probes_version},
                                   {"codec", probes.codec},
                                   {"coefficients", probes.coefficients_per_probe},
                                   {"frame", "world"},
                                   {"file", binary_file},
                                   {"count", probes.size()},
                                   {"grid", std::move(grid)},
                                   {"positions", std::move(positions)},
                                   {"validity", singles(probes.validity)},
                                   {"back_faces", singles(probes.back_faces)},
                                   {"cells", std::move(cells)},
                                   {"visibility", std::move(visibility)}};
    return json_text(document) + "\n";
}

Status write_probe_coefficients(StagedFile& file, const ProbeSet& probes) {
    assert(probes.coefficients.size() == probes.size() * probes.coefficients_per_probe);
    static_assert(sizeof(Rgb) == 3 * sizeof(float));
    for (const Rgb& c : probes.coefficients)
        if (!std::isfinite(c.r) || !std::isfinite(c.g) || !std::isfinite(c.b))
            return Error{"probes: a coefficient is not finite; is the light too bright for float32?"};
    return file.write(std::as_bytes(std::span(probes.coefficients)));
}

Status write_probe_visibility(StagedFile& file, const ProbeSet& probes) {
    return file.write(std::as_bytes(std::span(probes.visibility)));
}

Result<ProbeDescription> probes_from_json(std::string_view text, const std::string& name) {
    return read_json(text, name, [](const JsonPlace& top) {
        ProbeDescription result;
        result.file = read_description(top, result.probes);
        if (const auto visibility = top.find("visibility")) {
            result.visibility = visibility->at("file").file_name();
            result.probes.visibility_side = visibility->at("side").whole(1, k_most_visibility_side);
        }
        return result;
    });
}

Result<ProbeSet> read_probes(const BakeFiles& files, const std::string& name) {
    const auto path = files.checked(name);
    if (!path) return path.error();
    const auto text = read_text(*path, k_most_mebibytes);
    if (!text) return text.error();
    auto description = probes_from_json(*text, path->string());
    if (!description) return description.error();
    const auto coefficients = files.checked(description->file);
    if (!coefficients) return coefficients.error();
    if (auto status = read_coefficients(*coefficients, description->probes); !status) return status.error();
    if (description->visibility) {
        const auto visibility = files.checked(*description->visibility);
        if (!visibility) return visibility.error();
        if (auto status = read_visibility(*visibility, description->probes); !status) return status.error();
    }
    return std::move(description->probes);
}

}  // namespace lobelia
