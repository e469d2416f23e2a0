#pragma once

#include <Eigen/Core>
#include <optional>

namespace microinjection {

/// Whether there is a vector and it is finite.
inline bool isValid(const std::optional<Eigen::Vector3d>& vector) { return vector && vector->allFinite(); }

/// The vector; if it is longer than `limit`, the one of that length along it.
inline Eigen::Vector3d clampedNorm(const Eigen::Vector3d& vector, double limit) {
  const double norm = vector.norm();
  return norm > limit ? Eigen::Vector3d(vector * (limit / norm)) : vector;
}

}  // namespace microinjection
