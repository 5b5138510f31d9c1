// The environment that the literature publishes its figures on, where the shared folder has it.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>

#include "io/read_image.h"

namespace lobelia::test {

inline std::filesystem::path ennis_path() { return LOBELIA_SHARED_DIR "/data/ennis.hdr"; }

/// ennis.hdr, 256 x 128.
inline const Image& ennis() {
    static const Image image = read_environment(ennis_path()).value().image;
    return image;
}

}  // namespace lobelia::test

#define SKIP_WITHOUT_ENNIS() \
    if (!std::filesystem::exists(lobelia::test::ennis_path())) GTEST_SKIP() << "no " << lobelia::test::ennis_path()
