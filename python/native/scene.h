// What lobelia.Scene holds.
#pragma once

#include <memory>

#include "lobelia/gltf.h"

namespace lobelia::python {

/// A scene that a bake may hold on to: changes make a new one.
struct SceneHandle {
    std::shared_ptr<const LoadedScene> loaded;

    template <class Change>
    void change(const Change& change) {
        auto copy = std::make_shared<LoadedScene>(*loaded);
        change(*copy);
        loaded = std::move(copy);
    }
};

}  // namespace lobelia::python
