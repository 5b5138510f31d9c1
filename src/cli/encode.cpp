// lobelia encode, eval and reference: coefficients for scripts, what they give back, and what they should.
#include <fmt/core.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>

#include "cli/bake_input.h"
#include "cli/common.h"
#include "cli/eval_bake.h"
#include "cli/lobe_files.h"
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
    const Samples samples =
        arriving_samples(environment->image, codec->basis().domain(), comparison_options(options.sampling));
    const CoefficientFile file{codec->name(), codec->encode(samples)};
    for (const Rgb& c : file.c)
        if (!std::isfinite(c.r + c.g + c.b))
            return Error{options.codec + ": the coefficients of " + environment->info.name + " are not finite"};
    return write_file_atomically(options.out,
                                 to_json(file).dump(1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
}

/// Where something is evaluated, and the file it goes to.
struct OutputOptions {
    std::string normals;
    std::string lat_long;
    std::string out;
    bool radiance = false;
    double exposure = 0;
};

void add_output_options(CLI::App& command, OutputOptions& options) {
    command.add_option("--normals", options.normals, "A text file of normals, \"x y z\" a line (normalised)");
    command.add_option("--latlong", options.lat_long, "Normals of a latitude-longitude grid, WxH");
    command.add_flag("--radiance", options.radiance, "Radiance in those directions instead of irradiance");
    command.add_option("--exposure", options.exposure, "Of .png pictures [EV]; they show E / pi, or L")
        ->check(number_in(-32, 32))
        ->capture_default_str();
    command.add_option("-o,--output", options.out, "The file to write: .exr, .csv with x,y,z,r,g,b, or .png")
        ->required();
}

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

/// Directions as the options name them, in the frame of a domain: a grid, or one row.
struct Target {
    LatLong grid;
    Directions directions;
};

Result<Target> target_of(const OutputOptions& options, Domain domain) {
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

Status write_values(const OutputOptions& options, const Target& target, const Colours& values) {
    const auto extension = std::filesystem::path(options.out).extension();
    if (extension == ".csv") return write_file_atomically(options.out, as_csv(target.directions, values));
    Image image(target.grid.width, target.grid.height);
    for (std::size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] = colour_at(values.view(), i);
    if (extension == ".exr") return write_exr(options.out, image);
    const double shown = std::exp2(options.exposure) / (options.radiance ? 1 : k_pi);
    return write_png(options.out, to_srgb(image, static_cast<float>(shown)));
}

struct EvalOptions {
    std::string coefficients;
    std::string evaluator;
    bool irradiance = false;
    OutputOptions output;
};

Status eval_verb(const EvalOptions& options) {
    if (is_bake(options.coefficients)) {
        if (!options.irradiance || !options.output.normals.empty() || !options.output.lat_long.empty())
            return Error{options.coefficients + ": of a bake, --irradiance at each texel's normal is what can be read"};
        return eval_bake({options.coefficients, options.evaluator, options.output.out});
    }
    const auto text = read_text(options.coefficients, 1);
    if (!text) return text.error();
    const auto file = coefficients_from_json(*text, options.coefficients);
    if (!file) return file.error();
    CodecName name = file->codec;
    if (!options.evaluator.empty()) name.evaluator = options.evaluator;
    const auto codec = make_codec(name.str());
    if (!codec) return codec.error();
    const auto target = target_of(options.output, codec->basis().domain());
    if (!target) return target.error();
    Colours values(target->directions.size());
    if (options.output.radiance)
        codec->radiance(file->c, target->directions, values);
    else
        codec->irradiance(file->c, target->directions, values);
    return write_values(options.output, *target, values);
}

struct ReferenceOptions {
    EnvironmentOptions environment;
    OutputOptions output;
};

Status reference_verb(const ReferenceOptions& options) {
    const auto target = target_of(options.output, Domain::sphere);
    if (!target) return target.error();
    const auto environment = load(options.environment);
    if (!environment) return environment.error();
    const Image& image = environment->image;
    if (!options.output.radiance) {
        const Image reduced = resize(image, reduced_grid(lat_long(image), ComparisonOptions().most_texels));
        return write_values(options.output, *target, exact_irradiance(texel_samples(reduced), target->directions));
    }
    if (!options.output.lat_long.empty())
        return write_values(options.output, *target, radiance_of(resize(image, target->grid)));
    Colours values(target->directions.size());
    for (std::size_t i = 0; i < values.size(); ++i)
        set_entry(values.view(), i, image.pixels[lat_long(image).index(direction_at(target->directions, i))]);
    return write_values(options.output, *target, values);
}

}  // namespace

Verb add_encode(CLI::App& app) {
    auto options = std::make_shared<EncodeOptions>();
    CLI::App* command = app.add_subcommand("encode", "Encode an environment; write its coefficients as JSON");
    add_environment_options(*command, options->environment);
    add_sampling_options(*command, options->sampling);
    command->add_option("--codec", options->codec, "basis/encoder/evaluator, see lobelia list")
        ->transform(CLI::Validator(replace_lobe_file, ""))
        ->required();
    command->add_option("-o,--output", options->out, "The file to write")->required();
    return {command, [options] { return encode_verb(*options); }};
}

Verb add_eval(CLI::App& app) {
    auto options = std::make_shared<EvalOptions>();
    CLI::App* command =
        app.add_subcommand("eval", "Read coefficients as irradiance E [W/m^2] (not E / pi) or radiance [W/(m^2 sr)]");
    command
        ->add_option("COEFFICIENTS", options->coefficients,
                     "A file that lobelia encode wrote, or the folder of a bake: then --irradiance -o FOLDER")
        ->required();
    add_output_options(*command, options->output);
    command->add_option("--evaluator", options->evaluator,
                        "Another way to read the same basis, see lobelia list --axes");
    command
        ->add_flag("--irradiance", options->irradiance,
                   "What is read unless --radiance is given; of a bake, at each texel's normal: an .exr with R, G, B "
                   "and validity for each page")
        ->excludes("--radiance");
    return {command, [options] { return eval_verb(*options); }};
}

Verb add_reference(CLI::App& app) {
    auto options = std::make_shared<ReferenceOptions>();
    CLI::App* command = app.add_subcommand("reference",
                                           "Exact irradiance E [W/m^2] of an environment, summed over its texels "
                                           "(above 131072, of the reduced one); or its radiance");
    add_environment_options(*command, options->environment);
    add_output_options(*command, options->output);
    return {command, [options] { return reference_verb(*options); }};
}

}  // namespace lobelia::cli
