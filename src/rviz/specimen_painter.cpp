#include "rviz/specimen_painter.h"

#include <QFontMetrics>
#include <cmath>
#include <utility>

#include "operation/console/specimen_lines.h"
#include "rviz/colours.h"

namespace microinjection {
namespace {

using cell_microinjection::CellInImage;
using cell_microinjection::PipetteInImage;
using Eigen::Vector2d;

constexpr QRgb kCellColour = 0xff50dc50, kZonaColour = 0xffffa03c, kNeedleColour = 0xffff5a5a,
               kHoldingColour = 0xff50ffff, kDimpleColour = 0xffffffff, kGoalColour = 0xffff50ff, kShade = 0xb0101418;
constexpr double kCross = 6;            // px of the widget
constexpr double kGoalRadius = 9;       // px of the widget
constexpr double kAxis = 60;            // px of the widget, of a pipette's axis
constexpr double kFarthestPixel = 1e6;  // px: what is beyond is no place in an image

QPointF toPoint(const Vector2d& place) { return {place.x(), place.y()}; }

bool isPlace(double x, double y) { return std::abs(x) < kFarthestPixel && std::abs(y) < kFarthestPixel; }

template <typename Message>
FindingView toView(const Message& message) {
  using Verdict = FindingView::Verdict;
  const Verdict verdict = message.verdict == Message::FOUND       ? Verdict::kFound
                          : message.verdict == Message::UNCERTAIN ? Verdict::kUncertain
                                                                  : Verdict::kNotFound;
  return {verdict, message.reason};
}

template <typename Message>
bool canBeDrawn(const Message& message) {
  return message.verdict != Message::NOT_FOUND && isPlace(message.x, message.y);
}

QPen penOf(QRgb colour, bool found) {
  QPen pen(QColor(colour), 1.5, found ? Qt::SolidLine : Qt::DashLine);
  pen.setCosmetic(true);
  return pen;
}

void paintCell(QPainter& painter, const ImageView& view, const CellInImage& cell) {
  if (!canBeDrawn(cell)) return;
  const QPointF centre = toPoint(view.toWidget({cell.x, cell.y}));
  const bool found = cell.verdict == CellInImage::FOUND;
  painter.setPen(penOf(kCellColour, found));
  painter.drawLine(centre - QPointF(kCross, 0), centre + QPointF(kCross, 0));
  painter.drawLine(centre - QPointF(0, kCross), centre + QPointF(0, kCross));
  if (!(cell.diameter > 0 && cell.diameter < kFarthestPixel)) return;
  painter.setPen(penOf(kCellColour, found && std::isfinite(cell.diameter_deviation)));
  const double radius = cell.diameter / 2 * view.scale();
  painter.drawEllipse(centre, radius, radius);
  const double inner = radius - cell.zona_thickness * view.scale();
  if (!std::isfinite(inner) || inner <= 0) return;
  painter.setPen(penOf(kZonaColour, found && std::isfinite(cell.zona_thickness_deviation)));
  painter.drawEllipse(centre, inner, inner);
}

void paintPipette(QPainter& painter, const ImageView& view, const PipetteInImage& pipette, QRgb colour) {
  if (!canBeDrawn(pipette) || !std::isfinite(pipette.direction)) return;
  painter.setPen(penOf(colour, pipette.verdict == PipetteInImage::FOUND));
  const Vector2d end = view.toWidget({pipette.x, pipette.y});
  const Vector2d along(std::cos(pipette.direction), std::sin(pipette.direction)), across(-along.y(), along.x());
  const double wide = isPlace(pipette.half_width, 0) ? std::max(8.0, pipette.half_width * view.scale()) : 8;
  painter.drawLine(toPoint(end), toPoint(end + kAxis * along));
  painter.drawLine(toPoint(end - wide * across), toPoint(end + wide * across));
}

}  // namespace

void paintGoal(QPainter& painter, const ImageView& view, const Vector2d& pixel) {
  const QPointF place = toPoint(view.toWidget(pixel));
  painter.setBrush(Qt::NoBrush);
  // A dark line below it: it is seen on every background.
  for (const auto& [colour, width] : {std::pair(kShade, 4.0), std::pair(kGoalColour, 1.8)}) {
    QPen pen(QColor::fromRgba(colour), width);
    pen.setCosmetic(true);
    painter.setPen(pen);
    painter.drawEllipse(place, kGoalRadius, kGoalRadius);
    for (const QPointF& along : {QPointF(1, 0), QPointF(-1, 0), QPointF(0, 1), QPointF(0, -1)})
      painter.drawLine(place + 0.4 * kGoalRadius * along, place + 1.6 * kGoalRadius * along);
  }
}

void paintFindings(QPainter& painter, const ImageView& view, const cell_microinjection::VisionState& state) {
  painter.setBrush(Qt::NoBrush);
  paintCell(painter, view, state.cell);
  paintPipette(painter, view, state.holding_pipette, kHoldingColour);
  paintPipette(painter, view, state.injection_pipette, kNeedleColour);
  if (!canBeDrawn(state.indentation)) return;
  painter.setPen(penOf(kDimpleColour, state.indentation.verdict == CellInImage::FOUND));
  painter.drawEllipse(toPoint(view.toWidget({state.indentation.x, state.indentation.y})), kCross / 2, kCross / 2);
}

std::array<Lamp, 4> findingLines(const cell_microinjection::VisionState& state) {
  const double pixel_size = state.pixel_size > 0 && state.pixel_size < 1e-3 ? state.pixel_size : 0;
  return {findingLine("Cell", toView(state.cell), "diameter", state.cell.diameter, state.cell.diameter_deviation,
                      pixel_size),
          findingLine("Needle", toView(state.injection_pipette)),
          findingLine("Holding pipette", toView(state.holding_pipette)),
          findingLine("Dimple", toView(state.indentation), "depth", state.indentation.depth,
                      state.indentation.deviation, pixel_size)};
}

void paintScaleBar(QPainter& painter, const ImageView& view, double pixel_size) {
  if (!(pixel_size > 0 && pixel_size < 1e-3)) return;
  constexpr int kMargin = 8;
  const QRect area = painter.window();
  const double length = scaleBar(0.25 * area.width() / view.scale() * pixel_size);
  const double wide = length / pixel_size * view.scale();
  const QString text = QString::number(1e6 * length) + " um";
  const QFontMetrics metrics = painter.fontMetrics();
  const int box = std::max(static_cast<int>(wide), metrics.horizontalAdvance(text)) + 2 * kMargin;
  const int height = metrics.lineSpacing() + 12;
  const QRect frame(area.width() - box, area.height() - height, box, height);
  painter.fillRect(frame, QColor::fromRgba(kShade));
  painter.setPen(Qt::white);
  painter.drawText(frame.adjusted(0, 0, 0, -8), Qt::AlignCenter, text);
  painter.fillRect(QRectF(frame.center().x() - wide / 2, frame.bottom() - 7, wide, 3), Qt::white);
}

}  // namespace microinjection
