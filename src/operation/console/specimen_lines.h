#pragma once

#include <string>

#include "operation/console/light.h"

namespace microinjection {

/// What an image showed of the cell, a pipette or the dimple: found, uncertain or not found.
struct FindingView {
  enum class Verdict { kNotFound, kUncertain, kFound };
  Verdict verdict = Verdict::kNotFound;
  std::string reason;  ///< why not found or uncertain
};

/// "Needle: found"; "Needle: not found: REASON". Green, yellow, or grey for what is not there.
Lamp findingLine(const std::string& name, const FindingView& finding);

/// The same with a length in px and its standard deviation, in um where `pixel_size` (m) is known:
/// "Cell: found, diameter 56.0 +- 0.2 um". A deviation that is not finite leaves the length out.
Lamp findingLine(const std::string& name, const FindingView& finding, const std::string& length_name, double length,
                 double deviation, double pixel_size);

/// Length of a scale bar: 1, 2 or 5 times a power of ten of metres, at most `longest` (m).
double scaleBar(double longest);

}  // namespace microinjection
