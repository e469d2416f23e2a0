#include "rviz/microscope_view.h"

#include <QApplication>
#include <QMouseEvent>
#include <QPainter>
#include <QWheelEvent>
#include <cmath>

#include "rviz/specimen_painter.h"

namespace microinjection {
namespace {

constexpr double kAround = 2.2;     // diameters of the cell that are shown at first
constexpr double kNotch = 120;      // eighths of a degree, of a wheel
constexpr double kPerNotch = 1.25;  // magnification
constexpr int kClick = 5;           // px of the widget, that a hand moves during a click

Eigen::Vector2d toVector(const QPointF& point) { return {point.x(), point.y()}; }

QPointF placeOf(const QWheelEvent& event) {
#if QT_VERSION >= QT_VERSION_CHECK(5, 14, 0)
  return event.position();
#else
  return event.posF();
#endif
}

}  // namespace

MicroscopeView::MicroscopeView(QWidget* parent) : QWidget(parent) {
  setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Expanding);
  setAttribute(Qt::WA_OpaquePaintEvent);
  click_.setSingleShot(true);
  QObject::connect(&click_, &QTimer::timeout, this, [this] {
    if (reason_.isEmpty() && view_.contains(pressed_pixel_) && clicked_) clicked_(pressed_pixel_);
  });
}

void MicroscopeView::display(const QImage& image, const std::optional<cell_microinjection::VisionState>& specimen) {
  if (image.size() != image_.size()) chosen_ = false;
  image_ = image;
  specimen_ = specimen;
  reason_.clear();
  view_.setImage(image.width(), image.height());
  if (!chosen_ && !pressed_) showSpecimen();
  update();
}

void MicroscopeView::displayNone(const QString& reason) {
  if (reason == reason_) return;
  reason_ = reason;
  update();
}

/// Only once: a view that follows the cell would move under the operator's eye.
void MicroscopeView::showSpecimen() {
  if (!specimen_ || specimen_->cell.verdict != cell_microinjection::CellInImage::FOUND) return;
  const auto& cell = specimen_->cell;
  if (!view_.contains({cell.x, cell.y}) || !(cell.diameter > 0)) return;
  view_.showSquare({cell.x, cell.y}, kAround * cell.diameter);
  chosen_ = true;
}

void MicroscopeView::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.fillRect(rect(), QColor(24, 27, 34));
  if (!reason_.isEmpty()) {
    painter.setPen(Qt::white);
    painter.drawText(rect().adjusted(8, 8, -8, -8), Qt::AlignCenter | Qt::TextWordWrap, reason_);
    return;
  }
  const Eigen::Vector2d corner = view_.toWidget({-0.5, -0.5});
  painter.setRenderHint(QPainter::SmoothPixmapTransform);
  painter.drawImage(QRectF(corner.x(), corner.y(), image_.width() * view_.scale(), image_.height() * view_.scale()),
                    image_);
  painter.setRenderHint(QPainter::Antialiasing);
  if (goal_) paintGoal(painter, view_, *goal_);
  if (!specimen_) return;
  paintFindings(painter, view_, *specimen_);
  paintScaleBar(painter, view_, specimen_->pixel_size);
}

void MicroscopeView::setGoal(const std::optional<Eigen::Vector2d>& pixel) {
  if (pixel == goal_) return;
  goal_ = pixel;
  update();
}

void MicroscopeView::resizeEvent(QResizeEvent*) { view_.setWidget(width(), height()); }

void MicroscopeView::wheelEvent(QWheelEvent* event) {
  const double notches = event->angleDelta().y() / kNotch;
  if (event->modifiers() & Qt::ControlModifier) {
    turned_ += notches;
    const int whole = static_cast<int>(turned_);
    turned_ -= whole;
    if (whole != 0 && focus_moved_) focus_moved_(whole);
    return;
  }
  view_.zoom(toVector(placeOf(*event)), std::pow(kPerNotch, notches));
  chosen_ = true;
  update();
}

void MicroscopeView::mousePressEvent(QMouseEvent* event) {
  if (event->button() != Qt::LeftButton) return;
  pressed_ = dragged_ = event->pos();
  pressed_pixel_ = view_.toImage(toVector(event->pos()));
}

void MicroscopeView::mouseMoveEvent(QMouseEvent* event) {
  if (!dragged_ || !(event->buttons() & Qt::LeftButton)) return;
  if (pressed_ && (event->pos() - *pressed_).manhattanLength() < kClick) return;
  pressed_.reset();
  view_.pan(toVector(event->pos() - *dragged_));
  dragged_ = event->pos();
  chosen_ = true;
  update();
}

void MicroscopeView::mouseReleaseEvent(QMouseEvent* event) {
  if (event->button() != Qt::LeftButton || !pressed_) return;
  const bool stayed = (event->pos() - *pressed_).manhattanLength() < kClick;
  pressed_.reset();
  dragged_.reset();
  if (stayed) click_.start(QApplication::doubleClickInterval());
}

void MicroscopeView::mouseDoubleClickEvent(QMouseEvent*) {
  click_.stop();
  view_.showAll();
  chosen_ = true;
  update();
}

}  // namespace microinjection
