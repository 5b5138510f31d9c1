// Lightmap pages as textures for GPUs: coefficients in the layouts of storages, and validity.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "bake/write/files_together.h"
#include "io/texture/container.h"
#include "lobelia/bake.h"
#include "lobelia/lightmap.h"
#include "lobelia/storage.h"

namespace lobelia {

/// The textures of a bake's pages.
class PageTextures {
  public:
    /// An error for names that are not in the lists, for a storage that is not usable with the codec, for any without a
    /// codec, and for mip levels that pages of this size, width and height, cannot have.
    [[nodiscard]] static Result<PageTextures> make(const std::string& codec, const TextureOptions& options,
                                                   std::array<std::size_t, 2> page_size);

    [[nodiscard]] const std::vector<const Storage*>& storages() const { return storages_; }
    [[nodiscard]] const TextureContainer& container() const { return *container_; }

    /// Writes page-N.STORAGE.TEXTURE.CONTAINER, or page-N.STORAGE.FORMAT.CONTAINER for those that share an array
    /// texture, and page-N.validity.CONTAINER, packed storage by storage, and enters them in `entry`, whose page file
    /// has a name already. `origin` goes into the files' metadata: codec and frame.
    [[nodiscard]] Status add(FilesTogether& files, const LightmapPage& page, const std::string& origin,
                             PageEntry& entry) const;

  private:
    [[nodiscard]] Status add_storage(FilesTogether& files, std::span<const LightmapPage* const> levels,
                                     const Storage& storage, const std::string& origin, PageEntry& entry) const;
    [[nodiscard]] TextureFile texture_file(const PackedTexture& largest, std::size_t layers) const;

    TextureOptions options_;
    const TextureContainer* container_ = nullptr;
    std::vector<const Storage*> storages_;
    CoefficientTraits traits_;
};

}  // namespace lobelia
