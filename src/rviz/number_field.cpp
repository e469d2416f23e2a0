#include "rviz/number_field.h"

#include <QKeyEvent>

namespace microinjection {

NumberField::NumberField(double largest, int decimals, QWidget* parent) : QDoubleSpinBox(parent) {
  setRange(-largest, largest);
  setDecimals(decimals);
  setFocusPolicy(Qt::ClickFocus);
  QObject::connect(this, &QDoubleSpinBox::editingFinished, this, &QWidget::clearFocus);
}

bool NumberField::event(QEvent* event) {
  // A spin box takes every key that prints for its text, and would keep this one from the shortcut.
  if (event->type() == QEvent::ShortcutOverride && static_cast<QKeyEvent*>(event)->key() == Qt::Key_Space) {
    event->ignore();
    return true;
  }
  return QDoubleSpinBox::event(event);
}

void NumberField::wheelEvent(QWheelEvent* event) {
  if (hasFocus()) {
    QDoubleSpinBox::wheelEvent(event);
  } else {
    event->ignore();
  }
}

}  // namespace microinjection
