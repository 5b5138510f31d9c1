// Coefficients in textures as they are.
#include "lobelia/texture_packing.h"

#include <algorithm>

namespace lobelia {
namespace {

class Plain final : public TexturePacking {
  public:
    explicit Plain(std::size_t coefficients) : coefficients_(coefficients) {}
    [[nodiscard]] std::string name() const override { return "half"; }
    [[nodiscard]] std::size_t coefficients() const override { return coefficients_; }
    [[nodiscard]] std::string reading() const override { return "layer i holds coefficient i"; }
    [[nodiscard]] std::vector<TextureArray> textures() const override {
        TextureArray array{"c", TexelFormat::half, {}};
        for (std::size_t i = 0; i < coefficients_; ++i) array.layers.push_back("c" + std::to_string(i));
        return {array};
    }
    void pack(std::span<const Rgb> c, std::span<Rgb> layers) const override {
        std::copy(c.begin(), c.end(), layers.begin());
    }
    void unpack(std::span<const Rgb> layers, std::span<Rgb> c) const override {
        std::copy(layers.begin(), layers.end(), c.begin());
    }

  private:
    std::size_t coefficients_;
};

}  // namespace

std::shared_ptr<const TexturePacking> plain_packing(std::size_t coefficients) {
    return std::make_shared<Plain>(coefficients);
}

}  // namespace lobelia
