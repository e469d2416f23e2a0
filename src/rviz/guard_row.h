#pragma once

#include <QWidget>

#include "operation/console/guard_margins.h"

namespace microinjection {

/// A bar that fills up to a guard's limit, with its value and limit.
class GuardRow : public QWidget {
 public:
  explicit GuardRow(QWidget* parent = nullptr);
  void display(const GuardMargin& margin);
  QSize sizeHint() const override { return {150, 20}; }
  QSize minimumSizeHint() const override { return sizeHint(); }

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  GuardMargin margin_;
};

}  // namespace microinjection
