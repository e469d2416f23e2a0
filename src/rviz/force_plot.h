#pragma once

#include <qwt_plot.h>

#include <QString>
#include <optional>
#include <vector>

#include "operation/console/force_history.h"

class QwtPlotCurve;
class QwtPlotMarker;
class QwtPlotZoneItem;

namespace microinjection {

/// A plot of the force: lines, the guard of the force, and a guard and the expected puncture across
/// when the abscissa is the depth. Limits beyond the scale are not shown; the guards' bars have them.
class ForcePlot : public QwtPlot {
 public:
  /// Limits in the plot's units; empty: not known.
  struct Limits {
    std::optional<double> force, across, puncture, puncture_low, puncture_high;
  };

  explicit ForcePlot(QWidget* parent = nullptr);
  /// `left`, `right`: of the abscissa.
  void display(const PlotLine& predicted, const PlotLine& measured, double left, double right);
  void showPast(const std::deque<PlotLine>& past);
  void showLimits(const Limits& limits);

 private:
  void scale(double left, double right, const PlotLine& predicted, const PlotLine& measured);
  QwtPlotCurve* makeCurve(QRgb colour, double z);
  QwtPlotMarker* makeMarker(bool upright, QRgb colour);

  QwtPlotCurve *predicted_, *measured_;
  std::vector<QwtPlotCurve*> past_;
  QwtPlotMarker *force_guard_, *across_guard_, *puncture_;
  QwtPlotZoneItem* interval_;
  double past_top_ = 0;  ///< uN
  double left_ = 0, right_ = 0, bottom_ = 0, top_ = 0;
};

}  // namespace microinjection
