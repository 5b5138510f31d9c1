// Files of lobes in names of bases and codecs on the command line: "sg:lobes.txt/moments/exact".
#pragma once

#include <string>

#include "lobelia/result.h"

namespace lobelia::cli {

/// `name` with the lobes in place of the file: "sg:FILE" and "sgh:FILE", with or without "/encoder/evaluator" after it,
/// become "sg{...}" and "sgh{...}". Other names stay as they are. Only for names that the user has typed: it opens the
/// file (regular, at most 1 MiB).
[[nodiscard]] Result<std::string> with_lobes_from_file(const std::string& name);

/// The same as a check of an option's values, which it replaces.
[[nodiscard]] std::string replace_lobe_file(std::string& name);

}  // namespace lobelia::cli
