#include "rviz/force_plot.h"

#include <qwt_plot_canvas.h>
#include <qwt_plot_curve.h>
#include <qwt_plot_grid.h>
#include <qwt_plot_marker.h>
#include <qwt_plot_zoneitem.h>
#include <qwt_scale_widget.h>

#include <QPen>
#include <algorithm>
#include <cmath>

#include "rviz/colours.h"

namespace microinjection {
namespace {

QVector<QPointF> toPoints(const PlotLine& line) {
  QVector<QPointF> points;
  points.reserve(static_cast<int>(line.size()));
  for (const PlotPoint& point : line) points.append({point.x, point.y});
  return points;
}

/// 1, 2 or 5 times a power of ten, so that the scale seldom changes.
double niceCeiling(double value) {
  const double power = std::pow(10, std::floor(std::log10(value)));
  for (const double step : {1.0, 2.0, 5.0}) {
    if (value <= step * power) return step * power;
  }
  return 10 * power;
}

}  // namespace

ForcePlot::ForcePlot(QWidget* parent) : QwtPlot(parent) {
  // The layout decides: Qwt asks for more room than a console has.
  setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Ignored);
  QFont small = font();
  for (const int axis : {QwtPlot::xBottom, QwtPlot::yLeft}) {
    setAxisFont(axis, small);
    setAxisMaxMajor(axis, 5);
    setAxisMaxMinor(axis, 0);
    axisWidget(axis)->setMargin(0);
  }
  auto* canvas = new QwtPlotCanvas(this);
  // Every frame is new: to draw it into a pixmap first would only cost.
  canvas->setPaintAttribute(QwtPlotCanvas::BackingStore, false);
  canvas->setFrameStyle(QFrame::NoFrame);
  setCanvas(canvas);
  setCanvasBackground(Qt::white);
  auto* grid = new QwtPlotGrid;
  grid->setPen(QColor(0xe4, 0xe7, 0xea), 0);
  grid->attach(this);
  interval_ = new QwtPlotZoneItem;
  interval_->setOrientation(Qt::Vertical);
  interval_->setBrush(QColor(0x7b, 0x3f, 0xa0, 40));
  interval_->setPen(QPen(Qt::NoPen));
  interval_->attach(this);
  for (std::size_t i = 0; i < ForceHistory::kPastContacts; ++i) past_.push_back(makeCurve(kPastColour, 10));
  predicted_ = makeCurve(kPredictedColour, 30);
  measured_ = makeCurve(kMeasuredColour, 20);
  force_guard_ = makeMarker(false, kGuardColour);
  across_guard_ = makeMarker(true, kGuardColour);
  puncture_ = makeMarker(true, kPunctureColour);
  showLimits({});
}

QwtPlotCurve* ForcePlot::makeCurve(QRgb colour, double z) {
  auto* curve = new QwtPlotCurve;
  curve->setPen(QColor(colour), 0);
  curve->setPaintAttribute(QwtPlotCurve::FilterPoints);
  curve->setPaintAttribute(QwtPlotCurve::ClipPolygons);
  curve->setZ(z);
  curve->attach(this);
  return curve;
}

QwtPlotMarker* ForcePlot::makeMarker(bool upright, QRgb colour) {
  auto* marker = new QwtPlotMarker;
  marker->setLineStyle(upright ? QwtPlotMarker::VLine : QwtPlotMarker::HLine);
  marker->setLinePen(QColor(colour), 0, Qt::DashLine);
  marker->attach(this);
  return marker;
}

void ForcePlot::display(const PlotLine& predicted, const PlotLine& measured, double left, double right) {
  predicted_->setSamples(toPoints(predicted));
  measured_->setSamples(toPoints(measured));
  scale(left, right, predicted, measured);
  replot();
}

void ForcePlot::scale(double left, double right, const PlotLine& predicted, const PlotLine& measured) {
  double lowest = 0, highest = past_top_;
  for (const PlotLine* line : {&predicted, &measured}) {
    for (const PlotPoint& point : *line) {
      lowest = std::min(lowest, point.y);
      highest = std::max(highest, point.y);
    }
  }
  constexpr double kSmallest = 0.1;  // uN: noise of a sensor at rest does not fill the plot
  const double top = niceCeiling(std::max(kSmallest, highest));
  const double bottom = lowest < -0.05 * top ? -niceCeiling(-lowest) : -0.05 * top;
  if (left != left_ || right != right_) setAxisScale(QwtPlot::xBottom, left, right);
  if (bottom != bottom_ || top != top_) setAxisScale(QwtPlot::yLeft, bottom, top);
  left_ = left;
  right_ = right;
  bottom_ = bottom;
  top_ = top;
}

void ForcePlot::showPast(const std::deque<PlotLine>& past) {
  past_top_ = 0;
  for (const PlotLine& line : past) {
    for (const PlotPoint& point : line) past_top_ = std::max(past_top_, point.y);
  }
  for (std::size_t i = 0; i < past_.size(); ++i) {
    past_[i]->setSamples(i < past.size() ? toPoints(past[i]) : QVector<QPointF>());
  }
}

void ForcePlot::showLimits(const Limits& limits) {
  force_guard_->setVisible(limits.force.has_value());
  if (limits.force) force_guard_->setYValue(*limits.force);
  across_guard_->setVisible(limits.across.has_value());
  if (limits.across) across_guard_->setXValue(*limits.across);
  puncture_->setVisible(limits.puncture.has_value());
  if (limits.puncture) puncture_->setXValue(*limits.puncture);
  const bool interval = limits.puncture_low && limits.puncture_high;
  interval_->setVisible(interval);
  if (interval) interval_->setInterval(*limits.puncture_low, *limits.puncture_high);
}

}  // namespace microinjection
