// Lightmap pages as textures for GPUs: the coefficients as storages lay them out, and the validity beside them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bake/solve/pages.h"
#include "bake/write/files_together.h"
#include "bake/write/manifest.h"
#include "lobelia/storage.h"

namespace lobelia {

/// In which textures the pages of a bake are written.
class PageTextures {
  public:
    /// `storages` by name, absent for default_storages(). An error for one that does not suit the codec, or for any
    /// where there is no codec.
    [[nodiscard]] static Result<PageTextures> make(const std::string& codec,
                                                   const std::optional<std::vector<std::string>>& storages);

    /// Writes page-N.STORAGE.TEXTURE.ktx2 and page-N.validity.ktx2, packed one at a time, and enters them in `baked`,
    /// whose own file has a name already. `origin` is a text for whoever finds a file alone: codec and frame.
    [[nodiscard]] Status add(FilesTogether& files, const Page& page, const std::string& origin, BakedPage& baked) const;

  private:
    std::vector<const Storage*> storages_;
    CoefficientTraits traits_;
};

}  // namespace lobelia
