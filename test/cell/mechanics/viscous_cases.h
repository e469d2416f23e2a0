#pragma once

#include <limits>

#include "cell/material/viscoelasticity.h"
#include "cell/mechanics/bodies.h"

namespace microinjection {

constexpr double kForever = std::numeric_limits<double>::infinity();
const ViscoelasticityConfig kProny = {{{0.8, 0.1}, {1.5, 2.0}}};
const ViscoelasticityConfig kAll = {{{0.8, 0.1}, {1.5, 2.0}}, 0.3};  // Pa s

using ViscousCases = testing::Types<ElementCase<2, ElementKind::kP1>, ElementCase<2, ElementKind::kP2P0>,
                                    ElementCase<2, ElementKind::kP2P1>, ElementCase<3, ElementKind::kP1>,
                                    ElementCase<3, ElementKind::kMini>, ElementCase<3, ElementKind::kP2P0>>;

}  // namespace microinjection
