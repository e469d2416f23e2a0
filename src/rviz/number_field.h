#pragma once

#include <QDoubleSpinBox>

namespace microinjection {

/// A field for a number. The space bar stays that of STOP while the field has the focus, and the wheel changes the
/// number only then: a wheel that is meant for the pane beside it does not.
class NumberField : public QDoubleSpinBox {
 public:
  /// From -largest to largest.
  NumberField(double largest, int decimals, QWidget* parent);

 protected:
  bool event(QEvent* event) override;
  void wheelEvent(QWheelEvent* event) override;
};

}  // namespace microinjection
