// Reads files of lobes that names on the command line refer to.
#include "cli/lobe_files.h"

#include <filesystem>

#include "io/read_file.h"
#include "lobelia/bases.h"

namespace lobelia::cli {
namespace {

/// The path in "PATH" or "PATH/encoder/evaluator", which may hold slashes itself: the whole if there is such a file.
std::string_view path_of(std::string_view rest) {
    std::error_code error;
    if (std::filesystem::is_regular_file(rest, error)) return rest;
    const auto last = rest.rfind('/');
    const auto first = last == std::string_view::npos || last == 0 ? last : rest.rfind('/', last - 1);
    return first == std::string_view::npos ? rest : rest.substr(0, first);
}

}  // namespace

Result<std::string> with_lobes_from_file(const std::string& name) {
    for (const auto& [prefix, domain] : {std::pair{"sg:", Domain::sphere}, std::pair{"sgh:", Domain::hemisphere}}) {
        if (!name.starts_with(prefix)) continue;
        const std::string rest = name.substr(std::string_view(prefix).size());
        const std::string path(path_of(rest));
        const auto text = read_text(path, 1);
        if (!text) return text.error();
        auto lobes = parse_lobes(*text, path);
        if (!lobes) return lobes.error();
        return spherical_gaussians(*std::move(lobes), domain)->name() + rest.substr(path.size());
    }
    return name;
}

std::string replace_lobe_file(std::string& name) {
    auto replaced = with_lobes_from_file(name);
    if (!replaced) return replaced.error().message;
    name = *std::move(replaced);
    return {};
}

}  // namespace lobelia::cli
