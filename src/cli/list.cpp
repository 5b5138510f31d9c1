// lobelia list: every codec, or what codecs are made of.
#include <algorithm>

#include "cli/lobe_files.h"
#include "cli/options.h"
#include "cli/output.h"
#include "cli/verbs.h"
#include "core/storage/layout_text.h"
#include "io/texture/container.h"
#include "lobelia/codec.h"
#include "lobelia/storage.h"
#include "measure/bases_document.h"
#include "scene/light/light_kind.h"

namespace lobelia::cli {
namespace {

enum class Output { text, json };

struct ListArguments {
    bool axes = false, markdown = false;
    std::string storages;
    bool json = false;
};

/// Each evaluator with its bases; one line for each accuracy that the bases state for it.
void print_evaluators() {
    struct Entry {
        std::string name, accuracy, bases;
    };
    std::vector<Entry> entries;
    for (const auto& basis_name : basis_names()) {
        const auto basis = make_basis(basis_name).value();
        for (const auto& name : basis->evaluator_names()) {
            const auto accuracy = basis->evaluator(name)->accuracy();
            const std::string text = fmt::format("{}: {}", accuracy.range, accuracy.error);
            const auto known = std::find_if(entries.begin(), entries.end(),
                                            [&](const Entry& e) { return e.name == name && e.accuracy == text; });
            if (known == entries.end())
                entries.push_back({name, text, basis_name});
            else
                known->bases += ", " + basis_name;
        }
    }
    std::stable_sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) { return a.name < b.name; });
    print_line("evaluators: valid range, largest error, bases");
    for (const Entry& e : entries) {
        print_line("  {:<20} {}", e.name, e.accuracy);
        print_line("  {:<20}   {}", "", e.bases);
    }
}

/// The specular evaluators with their bases; "sampled" works with all.
void print_specular() {
    std::vector<std::pair<std::string, std::string>> evaluators;
    for (const auto& basis_name : basis_names())
        for (const auto& name : make_basis(basis_name).value()->specular_names()) {
            const auto known =
                std::find_if(evaluators.begin(), evaluators.end(), [&](const auto& e) { return e.first == name; });
            if (known == evaluators.end())
                evaluators.emplace_back(name, basis_name);
            else
                known->second += ", " + basis_name;
        }
    evaluators.emplace_back("sampled", "every basis");
    print_line("specular evaluators");
    for (const auto& [name, bases] : evaluators) print_line("  {:<20} {}", name, bases);
}

void print_axes() {
    print_line("bases");
    for (const auto& name : basis_names()) print_line("  {:<20} {}", name, make_basis(name).value()->description());
    for (const auto& [pattern, meaning] : basis_name_patterns()) print_line("  {:<20} {}", pattern, meaning);
    print_line("  {:<20} {}", "sg:FILE, sgh:FILE",
               "on the command line: lobes from a file, a line \"x y z sharpness\" each");
    print_line("encoders");
    for (const auto& name : encoder_names()) print_line("  {}", name);
    print_line("encoders for study, not in the list of codecs");
    for (const auto& name : encoder_variant_names()) print_line("  {}", name);
    print_evaluators();
    print_specular();
    print_line("storages");
    for (const Storage& storage : storages()) print_line("  {:<20} {}", storage.name, storage.description);
    print_line("pixel formats of storages");
    for (const PixelFormat format : pixel_formats()) print_line("  {}", info(format).name);
    print_line("texture containers");
    for (const TextureContainer& container : texture_containers())
        print_line("  {:<20} {}", container.name, container.description);
    print_line("lights of scenes, besides emissive surfaces and the environment");
    for (const PunctualLight::Kind kind : light_kinds()) print_line("  {}", light_kind(kind).name);
    print_line("A codec is one of each, basis/encoder/evaluator; lobelia list prints the {} useful combinations.",
               all_codecs().size());
}

/// The traits of the coefficients of a codec; of a basis, those of its non-negative encoders if it has any.
Result<CoefficientTraits> traits_of(const std::string& name) {
    const auto basis = make_basis(name);
    if (basis) return coefficient_traits(*basis);
    if (name.find('/') == std::string::npos) return basis.error();
    const auto codec = make_codec(name);
    if (!codec) return codec.error();
    return coefficient_traits(*codec->encoder());
}

void print_layout(const Storage& storage, const TextureLayout& layout) {
    print_line("{:<14} {} bytes for a texel: {}", storage.name, bytes_per_texel(layout), storage.description);
    for (const auto& texture : layout.textures) {
        std::string channels;
        for (const StoredChannel& channel : texture.channels)
            channels += (channels.empty() ? "" : ", ") + channel_text(channel);
        print_line("  {:<10} {:<14}{}{}", texture.name, info(texture.format).name, channels,
                   texture.subsampling == 1 ? "" : ", for 2 x 2 texels");
    }
}

Status print_layouts(const std::string& name, Output output) {
    const auto traits = traits_of(name);
    if (!traits) return traits.error();
    std::string json;
    for (const Storage& storage : storages()) {
        if (!suits(storage, *traits)) continue;
        const TextureLayout layout = storage.layout(*traits);
        if (output == Output::text) print_layout(storage, layout);
        json += fmt::format("{}\n \"{}\": {}", json.empty() ? "" : ",", storage.name, layout_json(layout));
    }
    if (output == Output::json) print_text("{" + json + "\n}\n");
    return Done{};
}

}  // namespace

Verb add_list(CLI::App& app) {
    CLI::App* command = app.add_subcommand("list", "List codecs, or their parts");
    auto options = std::make_shared<ListArguments>();
    CLI::Option* axes =
        command->add_flag("--axes", options->axes, "List bases, encoders, evaluators, storages and the other lists");
    command->add_flag("--markdown", options->markdown, "Write docs/bases.md to standard output")->excludes(axes);
    auto* layouts =
        command->add_option("--storages", options->storages,
                            "List the textures of each storage that is compatible with this basis or codec");
    layouts->transform(CLI::Validator(replace_lobe_file, ""));
    command->add_flag("--json", options->json, "Print the textures as JSON")->needs(layouts);
    return {command, [options, layouts]() -> Status {
                if (layouts->count() > 0)
                    return print_layouts(options->storages, options->json ? Output::json : Output::text);
                if (options->axes)
                    print_axes();
                else if (options->markdown)
                    print_text(bases_markdown());
                else
                    for (const auto& codec : all_codecs()) print_line(codec.str());
                return Done{};
            }};
}

}  // namespace lobelia::cli
