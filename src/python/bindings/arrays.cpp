#include "python/bindings/arrays.h"

#include <sstream>

#include "base/errors.h"

namespace microinjection {

namespace py = pybind11;

namespace {

std::string shapeOf(const PyArray& array) {
  std::ostringstream text;
  text << '(';
  for (py::ssize_t i = 0; i < array.ndim(); ++i) text << (i > 0 ? ", " : "") << array.shape(i);
  text << (array.ndim() == 1 ? ",)" : ")");
  return text.str();
}

PyArray numbersOf(const char* name, const py::object& given) {
  PyArray array = PyArray::ensure(given);
  if (!array) {
    PyErr_Clear();
    throw ConfigError(std::string(name) + ": must be an array of numbers, found " +
                      py::str(py::type::of(given).attr("__name__")).cast<std::string>());
  }
  return array;
}

}  // namespace

PyPoints::PyPoints(const char* name, const py::object& given)
    : array(numbersOf(name, given)), single(array.ndim() == 1), points(nullptr, 3, 0) {
  const bool fits = (array.ndim() == 1 && array.shape(0) == 3) || (array.ndim() == 2 && array.shape(1) == 3);
  if (!fits)
    throw ConfigError(std::string(name) + ": shape " + shapeOf(array) + ": must be (3,) or (n, 3), x, y and z in m");
  new (&points) Eigen::Map<const Eigen::Matrix3Xd>(array.data(), 3, array.size() / 3);
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    if (points.col(i).allFinite()) continue;
    throw ConfigError(std::string(name) + ": row " + std::to_string(i) + " is not finite");
  }
}

PyArray PyPoints::result(std::initializer_list<py::ssize_t> rest) const {
  std::vector<py::ssize_t> shape(rest);
  if (!single) shape.insert(shape.begin(), points.cols());
  return PyArray(shape);
}

Eigen::VectorXd vectorOf(const char* name, const py::object& given) {
  const PyArray array = numbersOf(name, given);
  if (array.ndim() != 1) throw ConfigError(std::string(name) + ": shape " + shapeOf(array) + ": must be (n,)");
  const Eigen::VectorXd values = Eigen::Map<const Eigen::VectorXd>(array.data(), array.size());
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    if (!std::isfinite(values[i]))
      throw ConfigError(std::string(name) + ": value " + std::to_string(i) + " is not finite");
  }
  return values;
}

Eigen::Vector3d directionOf(const char* name, const py::object& given) {
  const Eigen::VectorXd values = vectorOf(name, given);
  if (values.size() != 3 || !(values.norm() > 0))
    throw ConfigError(std::string(name) + ": must be three numbers, not all 0");
  return values.normalized();
}

PyArray toArray(const Eigen::Ref<const Eigen::VectorXd>& values) {
  PyArray array(values.size());
  Eigen::Map<Eigen::VectorXd>(array.mutable_data(), values.size()) = values;
  return array;
}

PyArray rowsOf(const Eigen::Ref<const Eigen::MatrixXd>& columns) {
  PyArray array({columns.cols(), columns.rows()});
  Eigen::Map<Eigen::MatrixXd>(array.mutable_data(), columns.rows(), columns.cols()) = columns;
  return array;
}

}  // namespace microinjection
