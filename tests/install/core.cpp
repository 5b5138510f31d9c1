// A project that uses the core.
#include <lobelia/lobelia.h>

#include <iostream>

int main() {
    const auto codec = lobelia::make_codec("sh2/least-squares/convolution").value();
    const auto c = codec.encode(lobelia::texel_samples(lobelia::sky({64, 32})));
    std::cout << codec.name().str() << ": " << c.size() << " coefficients, mean " << 0.282095f * c[0].g << "\n";
}
