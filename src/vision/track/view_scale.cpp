#include "vision/track/view_scale.h"

namespace microinjection {
namespace {

/// Multiplies what is in px; places have their origin at the centre of the top-left pixel.
class Scale {
 public:
  explicit Scale(double factor) : factor_(factor) {}

  void length(double& value) const { value *= factor_; }
  void place(cv::Point2d& value) const { value = factor_ * (value + cv::Point2d(0.5, 0.5)) - cv::Point2d(0.5, 0.5); }
  void places(std::vector<cv::Point2d>& values) const {
    for (cv::Point2d& value : values) place(value);
  }
  template <typename Matrix>
  void covariance(Matrix& value) const {
    value *= factor_ * factor_;
  }
  void ellipse(Ellipse& value) const {
    place(value.centre);
    value.semi_axes *= factor_;
  }
  void border(CellBorder& border) const {
    ellipse(border.ellipse);
    ellipse(border.line);
    covariance(border.covariance);
    // What diameterDeviation() adds is in px of the frame that was searched.
    if (factor_ > 1) border.covariance(2, 2) += kModelDeviation * kModelDeviation * (factor_ * factor_ - 1);
    for (double* value : {&border.residual, &border.shift, &border.rim}) length(*value);
    border.contrast /= factor_;
    places(border.points);
  }
  void cell(CellDetection& cell) const {
    place(cell.centre);
    covariance(cell.centre_covariance);
    for (CellBorder* each : {&cell.zona_outer, &cell.zona_inner, &cell.ooplasm}) border(*each);
    ellipse(cell.polar_body.outline);
    for (OtherThing& other : cell.others) ellipse(other.ellipse);
    length(cell.agreed_diameter);
  }
  void pipette(PipetteDetection& pipette) const {
    place(pipette.end);
    covariance(pipette.covariance);
    length(pipette.half_width);
  }
  void bore(BoreBorder& border) const {
    length(border.length);
    length(border.deviation);
    place(border.place);
  }
  void hold(HoldDetection& hold) const {
    length(hold.gap);
    length(hold.deviation);
  }
  void dimple(Dimple& dimple) const {
    for (double* value : {&dimple.depth, &dimple.deviation, &dimple.displacement.depth, &dimple.displacement.deviation,
                          &dimple.displacement.gap})
      length(*value);
    place(dimple.deepest);
    ellipse(dimple.outline);
    covariance(dimple.centre_covariance);
    places(dimple.contour);
  }

 private:
  double factor_;
};

}  // namespace

SpecimenView scaled(SpecimenView view, double factor) {
  const Scale scale(factor);
  scale.cell(view.cell);
  scale.pipette(view.injection);
  scale.pipette(view.holding);
  scale.dimple(view.indentation);
  scale.bore(view.column);
  scale.bore(view.tongue);
  scale.hold(view.hold);
  return view;
}

PipetteDetection scaled(PipetteDetection pipette, double factor) {
  Scale(factor).pipette(pipette);
  return pipette;
}

CellDetectorConfig scaled(CellDetectorConfig config, double factor) {
  config.smallest_diameter *= factor;
  config.largest_diameter *= factor;
  return config;
}

PipetteDetectorConfig scaled(PipetteDetectorConfig config, double factor) {
  config.widest *= factor;
  config.region *= factor;
  return config;
}

}  // namespace microinjection
