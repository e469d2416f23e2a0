#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <Eigen/Core>
#include <string>

namespace microinjection {

using PyArray = pybind11::array_t<double, pybind11::array::c_style | pybind11::array::forcecast>;

/// Points of a Python call: an array of shape (3,) or (n, 3), or what numpy makes one of.
struct PyPoints {
  PyArray array;
  bool single = false;  ///< of shape (3,)
  Eigen::Map<const Eigen::Matrix3Xd> points;

  /// @throws ConfigError that names the argument, the shape and the first row that is not finite
  PyPoints(const char* name, const pybind11::object& given);

  /// An array for one value of `rest` a point: of shape (n, ...), or of that of one value.
  PyArray result(std::initializer_list<pybind11::ssize_t> rest) const;
};

/// A vector of numbers. @throws ConfigError that names the argument, its shape, and what is not finite
Eigen::VectorXd vectorOf(const char* name, const pybind11::object& given);
/// A unit vector from one of any length.
Eigen::Vector3d directionOf(const char* name, const pybind11::object& given);

PyArray toArray(const Eigen::Ref<const Eigen::VectorXd>& values);
/// Rows of the array are columns of the matrix.
PyArray rowsOf(const Eigen::Ref<const Eigen::MatrixXd>& columns);

}  // namespace microinjection
