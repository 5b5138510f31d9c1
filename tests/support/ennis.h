// The environment used by published figures, if the data folder contains it.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>

#include "data.h"
#include "io/read_image.h"

namespace lobelia::test {

inline std::filesystem::path ennis_path() { return data_folder() / "ennis.hdr"; }

/// ennis.hdr, 256 x 128.
inline const Image& ennis() {
    static const Image image = read_environment(ennis_path()).value().image;
    return image;
}

}  // namespace lobelia::test

#define SKIP_WITHOUT_ENNIS()                                                                                        \
    if (!std::filesystem::exists(lobelia::test::ennis_path()))                                                      \
    GTEST_SKIP() << "no " << lobelia::test::ennis_path()                                                            \
                 << ": set LOBELIA_DATA to a folder with ennis.hdr (256 x 128; Ennis-Brown House of the USC light " \
                    "probes, as it comes with Probulator: github.com/kayru/Probulator, Data/Images)"
