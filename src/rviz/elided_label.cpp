#include "rviz/elided_label.h"

#include <QPainter>
#include <QTextLayout>

namespace microinjection {

ElidedLabel::ElidedLabel(int lines, QWidget* parent)
    : QWidget(parent), lines_(lines), colour_(palette().color(QPalette::WindowText)) {
  setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Fixed);
}

void ElidedLabel::setText(const QString& text) {
  if (text == text_) return;
  text_ = text;
  setToolTip(text);
  update();
}

void ElidedLabel::setColour(const QColor& colour) {
  if (colour == colour_) return;
  colour_ = colour;
  update();
}

QSize ElidedLabel::sizeHint() const { return {60, lines_ * fontMetrics().lineSpacing() + 2}; }

void ElidedLabel::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.setPen(colour_);
  const QFontMetrics metrics = fontMetrics();
  QTextLayout layout(text_, font());
  QTextOption option;
  option.setWrapMode(QTextOption::WrapAtWordBoundaryOrAnywhere);
  layout.setTextOption(option);
  layout.beginLayout();
  QStringList shown;
  for (int i = 0; i < lines_; ++i) {
    QTextLine line = layout.createLine();
    if (!line.isValid()) break;
    line.setLineWidth(width());
    const bool last = i + 1 == lines_;
    const QString rest = last ? text_.mid(line.textStart()) : text_.mid(line.textStart(), line.textLength());
    shown.append(last ? metrics.elidedText(rest, Qt::ElideRight, width()) : rest);
  }
  layout.endLayout();
  int top = (height() - static_cast<int>(shown.size()) * metrics.lineSpacing()) / 2;
  for (const QString& line : shown) {
    painter.drawText(0, top + metrics.ascent(), line);
    top += metrics.lineSpacing();
  }
}

}  // namespace microinjection
