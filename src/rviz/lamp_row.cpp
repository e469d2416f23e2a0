#include "rviz/lamp_row.h"

#include <QHBoxLayout>
#include <QPainter>

#include "rviz/colours.h"

namespace microinjection {

LampRow::Dot::Dot(QWidget* parent) : QWidget(parent) { setFixedSize(14, 14); }

void LampRow::Dot::setLight(Light light) {
  if (light == light_) return;
  light_ = light;
  update();
}

void LampRow::Dot::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.setRenderHint(QPainter::Antialiasing);
  painter.setPen(colourOf(light_).darker(130));
  painter.setBrush(colourOf(light_));
  painter.drawEllipse(QRectF(1.5, 1.5, 11, 11));
}

LampRow::LampRow(const QString& name, int lines, QWidget* parent)
    : QWidget(parent), dot_(new Dot(this)), text_(new ElidedLabel(lines, this)) {
  auto* layout = new QHBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->setSpacing(6);
  layout->addWidget(dot_);
  if (!name.isEmpty()) {
    auto* label = new QLabel(name, this);
    // The reasons of all rows begin at the same place.
    label->setFixedWidth(label->fontMetrics().horizontalAdvance("Estimate "));
    layout->addWidget(label);
  }
  layout->addWidget(text_, 1);
}

void LampRow::display(const Lamp& lamp) {
  dot_->setLight(lamp.light);
  text_->setText(QString::fromStdString(lamp.text));
}

}  // namespace microinjection
