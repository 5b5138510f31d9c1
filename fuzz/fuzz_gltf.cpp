// Feeds any bytes to the glTF reader. The result is an error with a message, or a scene that satisfies the contract of
// scene.h and can be written.
#include <cstdint>

#include "check_loaded.h"
#include "lobelia/gltf.h"
#include "scene/check_scene.h"
#include "scene/world.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace lobelia;
    // Small limits: a hostile file may cost no more than a few megabytes and milliseconds.
    GltfReadOptions options;
    options.most_bytes = 1 << 20;
    options.most_triangles = 1 << 12;
    options.most_objects = 1 << 8;
    options.most_texels = 1 << 14;
    // Every other file that the scene names holds the same bytes.
    const std::span bytes(reinterpret_cast<const std::byte*>(data), size);
    const ResourceReader resources = [&](const std::string& path, std::size_t most) -> Result<std::vector<std::byte>> {
        require(!path.empty() && path.front() != '/' && path.find("..") == std::string::npos);
        if (bytes.size() > most) return Error{"too large"};
        return std::vector<std::byte>(bytes.begin(), bytes.end());
    };
    const auto loaded = read_gltf(bytes, "fuzz", resources, options);
    if (!loaded) {
        require(!loaded.error().message.empty());
        return 0;
    }
    require(static_cast<bool>(check_scene(loaded->scene)));
    const World world = make_world(loaded->scene);
    require(!world.triangles.empty() && world.triangles.size() <= options.most_triangles);
    const auto written = encode_glb(loaded->scene);
    if (written) require(static_cast<bool>(read_gltf(std::as_bytes(std::span(*written)), "written", {})));
    return 0;
}
