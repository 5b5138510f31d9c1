// Finishing steps, chosen by the encoding.
#include "bake/finish/steps.h"

namespace lobelia {

bool denoise_pages(std::span<LightmapPage> pages, const BakeEncoding& encoding, const Guides& guides) {
    const PageChannels channels = encoding.page_channels();
    if (encoding.codec() == nullptr) {
        denoise(pages, channels, guides, {}, solid_angle(Domain::hemisphere));
        return true;
    }
    const Basis& basis = encoding.page_encoder()->basis();
    if (basis.linear() == nullptr) return false;
    denoise(pages, channels, guides, basis.linear()->integrals(), solid_angle(basis.domain()));
    return true;
}

void fit_codec(std::vector<LightmapPage>& pages, const BakeEncoding& encoding) {
    if (const FittedBasis* basis = encoding.fitted_last()) pages = fit_pages(pages, *basis);
}

}  // namespace lobelia
