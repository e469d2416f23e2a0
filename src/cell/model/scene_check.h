#pragma once

#include "cell/model/scene.h"

namespace microinjection {

/// Allowed needle/contact/mode of a disc, for messages.
inline constexpr char kDiscSticks[] =
    "sticking: the disc's sharp edge is the paper's nodal contact, which sticks; rounded_flat slides";

/// Implementation of Scene::validate().
void checkScene(const Scene& scene);

}  // namespace microinjection
