#include "nodes/cell/estimate_messages.h"

#include <algorithm>

namespace microinjection {

cell_microinjection::PuncturePrediction toMessage(const std::optional<PuncturePrediction>& prediction) {
  cell_microinjection::PuncturePrediction message;
  if (!prediction) return message;
  message.depth = prediction->depth;
  message.depth_low = prediction->depth_low;
  message.depth_high = prediction->depth_high;
  message.force = prediction->force;
  message.force_low = prediction->force_low;
  message.force_high = prediction->force_high;
  message.beyond = prediction->beyond;
  return message;
}

cell_microinjection::CellEstimate toMessage(const CellEstimate& estimate) {
  cell_microinjection::CellEstimate message;
  message.verdict = toText(estimate.verdict);
  message.reason = estimate.reason;
  message.modulus = estimate.modulus;
  message.modulus_low = estimate.modulus_low;
  message.modulus_high = estimate.modulus_high;
  message.contact = estimate.contact;
  message.offset = estimate.offset;
  std::copy_n(estimate.covariance.data(), 9, message.covariance.begin());  // symmetric
  message.depth = estimate.depth;
  message.misfit = estimate.misfit;
  message.samples = static_cast<std::uint32_t>(estimate.samples);
  return message;
}

}  // namespace microinjection
