// Reads normals, writes values.
#include "cli/evaluation_output.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <sstream>

#include "cli/common.h"
#include "cli/options.h"
#include "io/write_image.h"

namespace lobelia::cli {
namespace {

/// Reads unit directions from a text file: "x y z" or "x,y,z" a line, normalised; # starts a comment.
Result<Directions> read_normals(const std::string& path) {
    const auto text = read_text(path);
    if (!text) return text.error();
    std::vector<Vec3> normals;
    std::istringstream lines(*text);
    std::string line;
    for (std::size_t number = 1; std::getline(lines, line); ++number) {
        line = line.substr(0, line.find('#'));
        std::replace(line.begin(), line.end(), ',', ' ');
        if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
        std::istringstream fields(line);
        Vec3 n;
        std::string rest;
        if (!(fields >> n.x >> n.y >> n.z) || (fields >> rest) || !(length(n) > 1e-6f) || !(length(n) < 1e6f))
            return Error{fmt::format("{}:{}: expected a direction \"x y z\"", path, number)};
        normals.push_back(normalize(n));
    }
    if (normals.empty()) return Error{path + ": contains no normals"};
    Directions result(normals.size());
    for (std::size_t i = 0; i < normals.size(); ++i) set_entry(result.view(), i, normals[i]);
    return result;
}

/// One line for each direction: x, y, z, r, g, b.
std::string as_csv(DirectionView directions, ColourView values) {
    std::string text = "x,y,z,r,g,b\n";
    for (std::size_t i = 0; i < values.size; ++i) {
        const Vec3 d = direction_at(directions, i);
        const Rgb v = colour_at(values, i);
        text += fmt::format("{},{},{},{},{},{}\n", d.x, d.y, d.z, v.r, v.g, v.b);
    }
    return text;
}

}  // namespace

void add_evaluation_options(CLI::App& command, EvaluationOptions& options) {
    command.add_option("--normals", options.normals, "A text file of normals, \"x y z\" a line (normalised)");
    command.add_option("--latlong", options.lat_long, "Normals of a latitude-longitude grid, WxH");
    command.add_flag("--radiance", options.radiance, "Evaluate radiance in those directions instead of irradiance");
    command.add_option("--exposure", options.exposure, "Exposure of .png output in EV; they show E / pi, or L")
        ->check(number_in(-32, 32))
        ->capture_default_str();
    add_out_option(command, options.out, "Output file: .exr, .csv with x,y,z,r,g,b, or .png")->required();
}

Result<Target> target_of(const EvaluationOptions& options, Domain domain) {
    if (options.normals.empty() == options.lat_long.empty()) return Error{"give either --normals or --latlong"};
    const auto extension = std::filesystem::path(options.out).extension();
    if (extension != ".exr" && extension != ".csv" && extension != ".png")
        return Error{options.out + ": the output's name must end in .exr, .csv or .png"};
    if (!options.lat_long.empty()) {
        const auto grid = parse_grid(options.lat_long);
        if (!grid) return Error{"--latlong: " + grid.error().message};
        return Target{*grid, grid->directions(domain)};
    }
    auto directions = read_normals(options.normals);
    if (!directions) return directions.error();
    const LatLong row{directions->size(), 1};
    return Target{row, *std::move(directions)};
}

Status write_values(const EvaluationOptions& options, const Target& target, const Colours& values) {
    const auto extension = std::filesystem::path(options.out).extension();
    Image image(target.grid.width, target.grid.height);
    for (std::size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] = colour_at(values.view(), i);
    // Other programs read infinity as they like, and pictures show it as white.
    if (auto status = check_finite(image); !status) return Error{options.out + ": " + status.error().message};
    if (extension == ".csv") return write_file_atomically(options.out, as_csv(target.directions, values));
    if (extension == ".exr") return write_exr(options.out, image);
    const double shown = std::exp2(options.exposure) / (options.radiance ? 1 : k_pi);
    return write_png(options.out, to_srgb(image, static_cast<float>(shown)));
}

}  // namespace lobelia::cli
