// Feeds any numbers to every public function of bases, encoders, evaluators and storages: no crash, nothing out of
// bounds, no endless loop. See CMakeLists.txt for how to run it.
#include <cstring>
#include <map>

#include "check_loaded.h"
#include "hostile_numbers.h"

namespace lobelia {
namespace {

/// Bases, and encoders of each, made once: their tables take longer than many calls.
const std::shared_ptr<const Basis>& basis_at(std::size_t index) {
    static const auto bases = [] {
        std::vector<std::shared_ptr<const Basis>> made;
        for (const std::string& name : basis_names()) made.push_back(make_basis(name).value());
        return made;
    }();
    return bases[index % bases.size()];
}
const std::shared_ptr<const Encoder>& encoder_at(const std::shared_ptr<const Basis>& basis, std::size_t index) {
    static std::map<std::string, std::shared_ptr<const Encoder>> made;
    const auto names = encoder_names(*basis);
    const std::string& name = names[index % names.size()];
    auto& encoder = made[basis->name() + "/" + name];
    if (!encoder) encoder = make_encoder(name, basis).value();
    return encoder;
}

/// A basis of the lobes that the numbers give, by name: where the name is refused, a message says why.
std::shared_ptr<const Basis> lobes_from(test::Numbers& numbers) {
    std::string name = numbers() < 0.5f ? "sg{" : "sgh{";
    for (int i = 0; i < 3; ++i) {
        const Vec3 axis = numbers.vector();
        name += (i > 0 ? ";" : "") + std::to_string(axis.x) + " " + std::to_string(axis.y) + " " +
                std::to_string(axis.z) + " " + std::to_string(numbers());
    }
    const auto basis = make_basis(name + "}");
    if (basis) return *basis;
    require(!basis.error().message.empty());
    return nullptr;
}

void call(std::uint8_t what, std::uint8_t which, std::uint8_t how, test::Numbers& numbers) {
    const std::shared_ptr<const Basis> basis = which == 255 ? lobes_from(numbers) : basis_at(which);
    if (basis == nullptr) return;
    switch (what % 6) {
        case 0:
            return test::call_basis(*basis, numbers);
        case 1: {
            const auto names = basis->evaluator_names();
            const auto evaluator = make_evaluator(names[how % names.size()], *basis);
            return test::call_evaluator(**evaluator, basis->size(), numbers);
        }
        case 2: {
            const auto names = specular_names(*basis);
            const auto evaluator = make_specular(names[how % names.size()], basis);
            return test::call_specular(**evaluator, basis->size(), numbers);
        }
        case 3:
            if (which == 255) return test::call_encoder(make_encoder("moments", basis).value(), numbers);
            return test::call_encoder(encoder_at(basis, how), numbers);
        case 4: {
            const CoefficientTraits traits{1 + which % 5u, true, true, {1, 2, 2, 2, 2}};
            return test::call_storage(storages()[how % storages().size()], traits, numbers);
        }
        default:
            return test::call_samples(numbers);
    }
}

}  // namespace
}  // namespace lobelia

/// Three bytes choose the call, the rest are floats, used again and again.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    constexpr std::size_t header = 3;
    if (size < header + sizeof(float)) return 0;
    std::vector<float> values((size - header) / sizeof(float));
    std::memcpy(values.data(), data + header, values.size() * sizeof(float));
    lobelia::test::Numbers numbers(values);
    lobelia::call(data[0], data[1], data[2], numbers);
    return 0;
}
