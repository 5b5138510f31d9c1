// glTF extensions: supported, ignored with a warning, or refused.
#pragma once

#include "scene/gltf/document.h"

namespace lobelia::gltf {

/// The remedy for materials of KHR_materials_pbrSpecularGlossiness.
inline constexpr std::string_view k_metalrough =
    "convert its materials first: gltf-transform metalrough IN.glb OUT.glb";

/// Refuses a file that requires an extension which is not supported; warns about those that it only uses.
void check_extensions(Document& document, const JsonPlace& root);

}  // namespace lobelia::gltf
