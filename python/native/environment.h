// What lobelia.Environment holds.
#pragma once

#include <memory>

#include "lobelia/environment.h"

namespace lobelia::python {

/// Never changed once it is made, so that arrays may view it and copies share it.
struct Environment {
    std::shared_ptr<const Image> image;
};

}  // namespace lobelia::python
