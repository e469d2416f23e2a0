#pragma once

#include "vision/frame/ellipse.h"
#include "vision/frame/frame.h"

namespace microinjection {

/// How clear lines outside of a border are, over the border's own: the third of twelve sectors, so that pipettes do not
/// count. Lines are outside from 6 px to a tenth of the radius, at least 15 px. DIC shades a line on two sides only,
/// and an ellipse that is on the outer line of one side and on the inner line of the other has the outer one outside.
/// There it is above 0.25; about the right border it is below 0.2.
double linesOutside(const Frame& frame, const Ellipse& border);

}  // namespace microinjection
