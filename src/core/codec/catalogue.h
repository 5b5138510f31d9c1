// THE lists of bases and encoders, with a card for each entry. Code that must know all of them iterates over these.
#pragma once

#include "lobelia/codec.h"

namespace lobelia {

/// A family of bases: how to make its members by name, and its card.
struct BasisEntry {
    std::string_view names;  ///< the listed members, separated by spaces
    /// The basis of that name; null if the name belongs to another family; an error if it is a bad name of this one.
    Result<std::shared_ptr<const Basis>> (*make)(std::string_view name);
    BasisCard card;
    std::span<const NamePattern> patterns = {};  ///< further names that `make` knows
};
[[nodiscard]] std::span<const BasisEntry> basis_entries();

/// Which bases an encoder works with.
enum class Needs { any_basis, non_negative_basis };
/// Variants for study are known by name but not part of the product.
enum class Listed { yes, no };

struct EncoderEntry {
    std::string_view name;
    Needs needs;
    std::string_view limit;  ///< the encoder whose solution this one converges to
    std::shared_ptr<const Encoder> (*make)(std::shared_ptr<const LinearBasis>);
    Listed listed = Listed::yes;
};
[[nodiscard]] std::span<const EncoderEntry> encoder_entries();

}  // namespace lobelia
