#pragma once

namespace microinjection {

/// Prints to stderr what touch and puncture are felt with under the virtual sensor's noise, drift
/// and converter: false alarms of a needle that feels nothing, and latencies.
void printDetectionFigures();

}  // namespace microinjection
