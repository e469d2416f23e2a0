#include "cell/estimation/indentation_course.h"

#include <algorithm>

namespace microinjection {
namespace {

constexpr double kDepthStep = 50e-9;  // m, between two predictions that are kept

}  // namespace

IndentationCourse::Event IndentationCourse::follow(const Eigen::Vector3d& tip, const Cell& cell,
                                                   std::optional<unsigned> punctures) {
  Event event = Event::kNone;
  if (tip.norm() > cell.clear) {
    if (touched_) {
      *this = {};
      event = Event::kEnded;
    }
    clear_ = true;
  }
  if (!touched_) {
    start_ = tip;
    surface_ = lowest_ = tip.z();
  }
  // A fast needle touches before anything is learned.
  touched_ = touched_ || tip.norm() < cell.surface;
  if (!punctured_) lowest_ = std::min(lowest_, tip.z());
  if (!punctures) return event;
  if (!touched_) punctures_before_ = *punctures;
  if (punctured_ || *punctures <= punctures_before_) return event;
  punctured_ = true;
  return Event::kPunctured;
}

void IndentationCourse::learn(double depth) {
  touched_ = true;
  surface_ = lowest_ + depth;
}

void IndentationCourse::addForce(double force) {
  if (touched_) peak_ = std::max(peak_, force);
}

void IndentationCourse::expect(const PuncturePrediction& prediction) {
  if (expected_.empty() || depth() > expected_.back().first + kDepthStep) expected_.emplace_back(depth(), prediction);
}

double IndentationCourse::sideways(const Eigen::Vector3d& tip) const {
  return touched_ ? (tip - start_).head<2>().norm() : 0;
}

std::optional<PuncturePrediction> IndentationCourse::expectedAtHalf() const {
  std::optional<PuncturePrediction> result;
  for (const auto& [reached, prediction] : expected_) {
    if (reached > 0.5 * depth()) break;
    result = prediction;
  }
  return result;
}

}  // namespace microinjection
