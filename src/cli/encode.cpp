// lobelia encode and lobelia eval: coefficients for scripts, and what they give back.
#include <fmt/core.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>

#include "cli/common.h"
#include "cli/verbs.h"
#include "io/write_file.h"
#include "io/write_image.h"

namespace lobelia::cli {
namespace {

struct EncodeOptions {
    EnvironmentOptions environment;
    SamplingOptions sampling;
    std::string codec;
    std::string out;
};

Status encode_verb(const EncodeOptions& options) {
    const auto codec = make_codec(options.codec);
    if (!codec) return codec.error();
    const auto environment = load(options.environment);
    if (!environment) return environment.error();
    ComparisonOptions sampling;
    sampling.sequence = sequence_from_name(options.sampling.sequence);
    sampling.samples = options.sampling.samples;
    sampling.seed = options.sampling.seed;
    const Samples samples = arriving_samples(environment->image, codec->basis().domain(), sampling);
    const CoefficientFile file{codec->name(), codec->encode(samples)};
    return write_file_atomically(options.out, to_json(file).dump(1) + "\n");
}

struct EvalOptions {
    std::string coefficients;
    std::string normals;
    std::string lat_long;
    std::string out;
    bool radiance = false;
};

/// Unit directions from a text file: "x y z" or "x,y,z" a line, normalised; # starts a comment.
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
    if (normals.empty()) return Error{path + ": no normals in it"};
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

Status eval_verb(const EvalOptions& options) {
    if (options.normals.empty() == options.lat_long.empty()) return Error{"give either --normals or --latlong"};
    const auto extension = std::filesystem::path(options.out).extension();
    if (extension != ".exr" && extension != ".csv")
        return Error{options.out + ": the output's name must end in .exr or .csv"};
    const auto text = read_text(options.coefficients);
    if (!text) return text.error();
    const auto file = coefficients_from_json(*text, options.coefficients);
    if (!file) return file.error();

    // Find the directions: a grid of them, or one row.
    LatLong grid;
    Directions directions;
    if (!options.lat_long.empty()) {
        const auto parsed = parse_grid(options.lat_long);
        if (!parsed) return Error{"--latlong: " + parsed.error().message};
        grid = *parsed;
        directions = grid.directions();
    } else {
        auto read = read_normals(options.normals);
        if (!read) return read.error();
        directions = *std::move(read);
        grid = {directions.size(), 1};
    }

    const auto codec = make_codec(file->codec.str());
    if (!codec) return codec.error();
    Colours values(directions.size());
    if (options.radiance)
        codec->radiance(file->c, directions, values);
    else
        codec->irradiance(file->c, directions, values);
    if (extension == ".csv") return write_file_atomically(options.out, as_csv(directions, values));
    Image image(grid.width, grid.height);
    for (std::size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] = colour_at(values.view(), i);
    return write_exr(options.out, image);
}

}  // namespace

Verb add_encode(CLI::App& app) {
    auto options = std::make_shared<EncodeOptions>();
    CLI::App* command = app.add_subcommand("encode", "Encode an environment; write its coefficients as JSON");
    add_environment_options(*command, options->environment);
    add_sampling_options(*command, options->sampling);
    command->add_option("--codec", options->codec, "basis/encoder/evaluator, see lobelia list")->required();
    command->add_option("-o,--output", options->out, "The file to write")->required();
    return {command, [options] { return encode_verb(*options); }};
}

Verb add_eval(CLI::App& app) {
    auto options = std::make_shared<EvalOptions>();
    CLI::App* command =
        app.add_subcommand("eval", "Read coefficients as irradiance E [W/m^2] (not E / pi) or radiance [W/(m^2 sr)]");
    command->add_option("COEFFICIENTS", options->coefficients, "A file that lobelia encode wrote")->required();
    command->add_option("--normals", options->normals, "A text file of normals, \"x y z\" a line (normalised)");
    command->add_option("--latlong", options->lat_long, "Normals of a latitude-longitude grid, WxH");
    command->add_flag("--radiance", options->radiance, "Radiance in those directions instead of irradiance");
    command->add_option("-o,--output", options->out, "The file to write: .exr, or .csv with x,y,z,r,g,b")->required();
    return {command, [options] { return eval_verb(*options); }};
}

}  // namespace lobelia::cli
