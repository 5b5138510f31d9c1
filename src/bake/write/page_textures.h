// Lightmap pages as textures for GPUs: coefficients in the layouts of storages, and validity.
#pragma once

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
    /// Storages by name; absent: default_storages(). The container by name. An error for names that are not in the
    /// lists, for a storage that is not usable with the codec, and for any without a codec.
    [[nodiscard]] static Result<PageTextures> make(const std::string& codec,
                                                   const std::optional<std::vector<std::string>>& storages,
                                                   std::string_view container);

    [[nodiscard]] const std::vector<const Storage*>& storages() const { return storages_; }

    /// Writes page-N.STORAGE.TEXTURE.CONTAINER and page-N.validity.CONTAINER, packed one at a time, and enters them in
    /// `entry`, whose page file has a name already. `origin` goes into the files' metadata: codec and frame.
    [[nodiscard]] Status add(FilesTogether& files, const LightmapPage& page, const std::string& origin,
                             PageEntry& entry) const;

  private:
    const TextureContainer* container_ = nullptr;
    std::vector<const Storage*> storages_;
    CoefficientTraits traits_;
};

}  // namespace lobelia
