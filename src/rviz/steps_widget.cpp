#include "rviz/steps_widget.h"

#include <QPainter>

#include "rviz/colours.h"

namespace microinjection {
namespace {

constexpr int kHead = 8;     // px, of the arrow at the end of a step
constexpr int kHeight = 30;  // px

}  // namespace

StepsWidget::StepsWidget(QWidget* parent) : QWidget(parent) {
  setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Fixed);
}

QSize StepsWidget::sizeHint() const {
  const int widest = fontMetrics().horizontalAdvance("punctured") + 2 * kHead + 6;
  return {widest * static_cast<int>(StepStrip::kSteps.size()), kHeight};
}

void StepsWidget::display(std::optional<InjectionState> state) {
  if (state != shown_) update();
  shown_ = state;
  strip_.update(state);
}

void StepsWidget::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.setRenderHint(QPainter::Antialiasing);
  const int count = static_cast<int>(StepStrip::kSteps.size());
  const double wide = static_cast<double>(width()) / count;
  for (int i = 0; i < count; ++i) {
    const StepStrip::Mark mark = strip_.marks()[i];
    const bool present = mark == StepStrip::Mark::kPresent;
    const QColor ahead = strip_.fault() ? colourOf(Light::kRed).lighter(170) : QColor(kRefusedColour);
    const double left = i * wide, right = left + wide - kHead, middle = height() / 2.0, bottom = height() - 1.0;
    QPolygonF arrow;
    arrow << QPointF(left, 1) << QPointF(right, 1) << QPointF(right + kHead - 2, middle) << QPointF(right, bottom)
          << QPointF(left, bottom);
    if (i > 0) arrow << QPointF(left + kHead - 2, middle);
    painter.setPen(Qt::NoPen);
    painter.setBrush(present                            ? QColor(kOfferedColour)
                     : mark == StepStrip::Mark::kPassed ? QColor(kPassedColour)
                                                        : ahead);
    painter.drawPolygon(arrow);
    painter.setPen(present ? Qt::white : QColor(0x20, 0x24, 0x28));
    QFont font = this->font();
    font.setBold(present);
    painter.setFont(font);
    painter.drawText(QRectF(left + kHead / 2.0, 0, wide - kHead / 2.0, height()), Qt::AlignCenter,
                     strip_.text(static_cast<std::size_t>(i)));
  }
}

}  // namespace microinjection
