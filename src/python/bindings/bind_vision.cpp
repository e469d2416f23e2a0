// measure_cell(), find_tip(), render_specimen() and Calibration.

#include <pybind11/stl.h>

#include <cstdint>
#include <cstring>
#include <mutex>
#include <opencv2/core.hpp>

#include "base/errors.h"
#include "python/bindings/arrays.h"
#include "python/bindings/module.h"
#include "python/bindings/scene_value.h"
#include "vision/calibration/calibration_file.h"
#include "vision/measurement/cell_measurement.h"
#include "vision/measurement/vision_config.h"
#include "vision/microscope/microscope.h"
#include "vision/microscope/scene_draw.h"

namespace microinjection {

namespace py = pybind11;

namespace {

/// The pixels of an image, of 8 or 16 bit: grey, or RGB as Python's libraries read it. Shares the array's memory unless
/// it is coloured.
cv::Mat imageOf(const py::object& given) {
  const py::array array = py::array::ensure(given, py::array::c_style);
  if (!array) throw ConfigError("image: must be an array of pixels");
  const bool is_short = array.dtype().equal(py::dtype::of<std::uint16_t>());
  if (!is_short && !array.dtype().equal(py::dtype::of<std::uint8_t>()))
    throw ConfigError("image: pixels are " + py::str(array.dtype()).cast<std::string>() + ": must be uint8 or uint16");
  const bool grey = array.ndim() == 2, coloured = array.ndim() == 3 && array.shape(2) == 3;
  if (!grey && !coloured) throw ConfigError("image: must have the shape (height, width) or (height, width, 3)");
  const int type = CV_MAKETYPE(is_short ? CV_16U : CV_8U, grey ? 1 : 3);
  const cv::Mat view(static_cast<int>(array.shape(0)), static_cast<int>(array.shape(1)), type,
                     const_cast<void*>(array.data()));  // NOLINT: it is only read, and cloned
  cv::Mat image = view.clone();
  if (coloured) {
    std::vector<cv::Mat> planes;
    cv::split(image, planes);
    std::swap(planes[0], planes[2]);
    cv::merge(planes, image);
  }
  return image;
}

py::dict verdictOf(const Finding& finding) {
  py::dict result;
  result["verdict"] = nameOf(finding.verdict);
  result["reason"] = finding.reason;
  return result;
}

py::dict pipetteOf(const PipetteDetection& pipette) {
  py::dict result = verdictOf(pipette.finding);
  if (!pipette.finding.hasValues()) return result;
  result["place"] = py::make_tuple(pipette.end.x, pipette.end.y);
  py::array_t<double> covariance({2, 2});
  Eigen::Map<Eigen::Matrix2d>(covariance.mutable_data()) = pipette.covariance;
  result["covariance"] = covariance;
  result["direction"] = pipette.direction;
  result["direction_deviation"] = pipette.direction_deviation;
  result["half_width"] = pipette.half_width;
  return result;
}

py::object lengthOf(const std::optional<MeasuredLength>& length) {
  if (!length) return py::none();
  return py::make_tuple(length->value, length->value - length->interval, length->value + length->interval);
}

/// Finds things in images, one after another, as the node `vision` does.
class Vision {
 public:
  explicit Vision(const YAML::Node& keys) : config_(read(keys)), tracker_(config_.tracker, config_.secondEye()) {}

  SpecimenView next(const py::object& image) {
    const Frame frame(imageOf(image));
    const py::gil_scoped_release others;
    const std::lock_guard<std::mutex> one(mutex_);  // a frame after the other, whatever thread has it
    return tracker_.next(frame);
  }

 private:
  static VisionConfig read(const YAML::Node& keys) {
    ConfigReader reader(keys, "vision");
    VisionConfig config = VisionConfig::read(reader);
    reader.finish();
    return config;
  }
  VisionConfig config_;
  SpecimenTracker tracker_;
  std::mutex mutex_;
};

py::dict cellOf(const SpecimenView& view, double pixel_size) {
  py::dict result = verdictOf(view.cell.size);
  CellReadings readings(1);
  readings.add(view);
  std::string reason;
  const auto measured = readings.measure(1, pixel_size, reason);
  result["diameter"] = measured ? lengthOf(measured->diameter) : py::none();
  result["zona_thickness"] = measured ? lengthOf(measured->zona_thickness) : py::none();
  result["offset"] = measured ? lengthOf(measured->offset) : py::none();
  result["centre"] = view.cell.finding.hasValues() ? py::object(py::make_tuple(view.cell.centre.x, view.cell.centre.y))
                                                   : py::object(py::none());
  const PolarBody& body = view.cell.polar_body;
  result["polar_body"] = body.finding.isFound() ? py::object(py::float_(body.angle)) : py::object(py::none());
  return result;
}

py::array arrayOf(const cv::Mat& image) {
  const bool is_short = image.depth() == CV_16U;
  py::array result(is_short ? py::dtype::of<std::uint16_t>() : py::dtype::of<std::uint8_t>(), {image.rows, image.cols});
  std::memcpy(result.mutable_data(), image.data, image.total() * image.elemSize());
  return result;
}

py::object pixelOf(const Eigen::Vector2d& place) { return py::make_tuple(place.x(), place.y()); }

/// A random cell between two pipettes, as the virtual microscope sees them, with what is to be found.
py::tuple renderSpecimen(std::uint64_t seed, const py::dict& keys) {
  ConfigReader reader(toYaml(keys), "microscope");
  const MicroscopeConfig config = MicroscopeConfig::read(reader);
  reader.finish();
  Microscope microscope(config);
  SceneDrawConfig draw;
  draw.holding = draw.injection = 1;
  const DrawnScene drawn = drawScene(draw, config.camera, seed);
  cv::Mat image;
  {
    const py::gil_scoped_release others;
    image = microscope.render(drawn.scene, 0, seed);
  }
  py::dict truth;
  truth["pixel_size"] = config.camera.pixel_size;
  truth["tip"] = pixelOf(drawn.truth.injection->end);
  truth["centre"] = pixelOf(drawn.truth.cell->centre);
  truth["diameter"] = drawn.truth.cell->diameter;
  return py::make_tuple(arrayOf(image), truth);
}

}  // namespace

void bindVision(py::module_& module) {
  py::class_<Vision>(module, "Vision")
      .def(py::init([](const py::dict& keys) { return std::make_unique<Vision>(toYaml(keys)); }),
           py::arg("config") = py::dict())
      .def(
          "see",
          [](Vision& vision, const py::object& image, double pixel_size) {
            if (!(pixel_size > 0 && pixel_size < 1e-4)) throw ConfigError("pixel_size: must be in (0, 1e-4) m");
            const SpecimenView view = vision.next(image);
            py::dict result;
            result["cell"] = cellOf(view, pixel_size);
            result["injection_pipette"] = pipetteOf(view.injection);
            result["holding_pipette"] = pipetteOf(view.holding);
            return result;
          },
          py::arg("image"), py::arg("pixel_size"));

  module.def("render_specimen", &renderSpecimen, py::arg("seed"), py::arg("config") = py::dict());

  py::class_<CameraCalibration>(module, "Calibration")
      .def_static(
          "load", [](const py::object& path) { return readCalibration(py::str(path).cast<std::string>()); },
          py::arg("path"))
      .def(
          "pixel",
          [](const CameraCalibration& calibration, const py::object& place) {
            const PyPoints places("place", place);
            PyArray pixels = places.result({2});
            for (Eigen::Index i = 0; i < places.points.cols(); ++i)
              Eigen::Map<Eigen::Vector2d>(pixels.mutable_data() + 2 * i) = calibration.pixelOf(places.points.col(i));
            return pixels;
          },
          py::arg("place"))
      .def(
          "place",
          [](const CameraCalibration& calibration, const py::object& pixel, double y) {
            const Eigen::VectorXd at = vectorOf("pixel", pixel);
            if (at.size() != 2) throw ConfigError("pixel: must be two numbers, x and y in px");
            return toArray(Eigen::VectorXd(calibration.placeFor(at, y)));
          },
          py::arg("pixel"), py::arg("y") = 0.0)
      .def_property_readonly("date", [](const CameraCalibration& calibration) { return calibration.date; })
      .def_property_readonly("pixel_size",
                             [](const CameraCalibration& calibration) { return calibration.value[kPixelSize]; })
      .def_property_readonly("axes",
                             [](const CameraCalibration& calibration) {
                               PyArray axes({2, 3});
                               Eigen::Map<Eigen::Matrix<double, 2, 3, Eigen::RowMajor>>(axes.mutable_data()) =
                                   calibration.axes();
                               return axes;
                             })
      .def_property_readonly(
          "backlash",
          [](const CameraCalibration& calibration) { return toArray(Eigen::VectorXd(calibration.backlash())); })
      .def_property_readonly("residual", [](const CameraCalibration& calibration) { return calibration.residual; });
}

}  // namespace microinjection
