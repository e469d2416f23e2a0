#include "rviz/guard_row.h"

#include <QPainter>
#include <algorithm>
#include <utility>

#include "rviz/colours.h"

namespace microinjection {

GuardRow::GuardRow(QWidget* parent, QString name, QString text)
    : QWidget(parent), longest_name_(std::move(name)), longest_text_(std::move(text)) {
  setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Fixed);
}

void GuardRow::display(const GuardMargin& margin) {
  const bool same = margin.lamp.text == margin_.lamp.text && margin.lamp.light == margin_.lamp.light;
  if (same && margin.name == margin_.name) return;
  margin_ = margin;
  setToolTip(QString::fromStdString(margin.name + " " + margin.lamp.text));
  update();
}

void GuardRow::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  const int name_width = fontMetrics().horizontalAdvance(longest_name_) + 20;
  const int text_width = fontMetrics().horizontalAdvance(longest_text_);
  const QRect bar(name_width, 4, std::max(10, width() - name_width - text_width - 8), height() - 8);
  painter.setPen(palette().color(QPalette::WindowText));
  painter.drawText(QRect(0, 0, name_width, height()), Qt::AlignVCenter, QString::fromStdString(margin_.name));
  painter.fillRect(bar, QColor(kRefusedColour));
  QRect filled = bar;
  filled.setWidth(static_cast<int>(bar.width() * std::min(1.0, margin_.share)));
  painter.fillRect(filled, colourOf(margin_.lamp.light));
  painter.drawText(QRect(bar.right() + 8, 0, text_width, height()), Qt::AlignVCenter,
                   QString::fromStdString(margin_.lamp.text));
}

}  // namespace microinjection
