// The finishing stage as a bake runs it: selects the steps that apply to the coefficients.
#pragma once

#include "bake/finish/finish.h"
#include "bake/gather/encoding.h"

namespace lobelia {

/// Smooths noise. Returns false, without a change, if the pages' coefficients are not linear in the light.
[[nodiscard]] bool denoise_pages(std::span<LightmapPage> pages, const BakeEncoding& encoding, const Guides& guides,
                                 StopFlag stop = {});

/// Replaces the intermediate coefficients of the pages by those of the codec, if they differ.
void fit_codec(std::vector<LightmapPage>& pages, const BakeEncoding& encoding, StopFlag stop = {});

}  // namespace lobelia
