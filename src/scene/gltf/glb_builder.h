// Builds a binary glTF file: JSON, and the buffer that its accessors view.
#pragma once

#include <nlohmann/json.hpp>
#include <set>
#include <span>
#include <string>

#include "lobelia/math.h"
#include "lobelia/result.h"

namespace lobelia::gltf {

class GlbBuilder {
  public:
    GlbBuilder();
    [[nodiscard]] nlohmann::json& root() { return root_; }
    void use_extension(const char* name) { extensions_.insert(name); }

    /// Each function appends to an array of the file and returns the index there.
    std::size_t add(const char* array, nlohmann::json entry);
    std::size_t add_view(std::string_view bytes, int target);
    std::size_t add_positions(std::span<const Vec3> values);  ///< with their bounds, which glTF requires
    std::size_t add_vectors(std::span<const Vec3> values);
    std::size_t add_vectors(std::span<const Vec2> values);
    std::size_t add_vectors(std::span<const std::array<float, 4>> values);
    /// Writes 16-bit indices if all are below 65535.
    std::size_t add_indices(std::span<const std::uint32_t> values);

    /// Returns the file's bytes. Errors: more than 4 GiB.
    [[nodiscard]] Result<std::string> finish();

  private:
    std::size_t add_accessor(std::string_view bytes, std::size_t count, nlohmann::json accessor, int target);

    nlohmann::json root_;
    std::string binary_;
    std::set<std::string> extensions_;
};

}  // namespace lobelia::gltf
