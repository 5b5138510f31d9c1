// Shader code of a codec, as a text that engines include.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "lobelia/codec.h"
#include "lobelia/storage.h"
#include "shade/language.h"

namespace lobelia::shade {

/// The functions of a text.
/// probes: weights of the eight probes around a place, as ProbeVolume has them.
enum class Need { irradiance, radiance, specular, probes };

struct NeedInfo {
    Need need;
    std::string_view name;        ///< of the function, and as options name it
    std::string_view parameters;  ///< after the coefficients; empty for probes, which have functions of their own
    std::string_view value;       ///< a comment
};
/// THE list, in the order of Need.
[[nodiscard]] std::span<const NeedInfo> needs();
[[nodiscard]] const NeedInfo& info(Need need);

/// The frame of the coefficients' directions: that of the scene, or one of each texel's own, about its normal.
enum class Frame { scene, tangent };

struct ShaderRequest {
    Language language = Language::glsl;
    std::vector<Need> needs = {Need::irradiance};
    const Storage* storage = nullptr;  ///< null: no struct Texel and no unpack()
    std::optional<Frame> frame;        ///< absent: tangent for a basis over the hemisphere
    std::string specular = {};         ///< the specular evaluator; empty: the basis's most accurate one
};

/// Returns the text: a comment with conventions and errors, struct Coefficients and the functions of them that are
/// needed; with a storage also struct Texel, which the caller fills with sampled values, and unpack(), which turns it
/// into coefficients; in the tangent frame also to_tangent(). The functions call only each other. Errors: a basis or an
/// evaluator without shader code, with the reason; a storage that does not suit the codec.
[[nodiscard]] Result<std::string> shader_text(const Codec& codec, const ShaderRequest& request);

}  // namespace lobelia::shade
