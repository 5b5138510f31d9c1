// Names of codecs, without files.
#include "bake/write/stored_codec.h"

namespace lobelia {

Result<CodecName> stored_codec_name(std::string_view text) {
    auto name = parse_codec_name(text);
    if (!name) return name;
    if (name->basis.find(':') != std::string::npos)
        return Error{"\"" + name->basis +
                     "\" names a file, which a bake must not: its codec must not depend on other files"};
    return name;
}

}  // namespace lobelia
