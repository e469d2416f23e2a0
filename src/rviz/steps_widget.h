#pragma once

#include <QWidget>
#include <optional>

#include "operation/console/step_strip.h"

namespace microinjection {

/// The steps of an injection from left to right, with the present one lit.
class StepsWidget : public QWidget {
 public:
  explicit StepsWidget(QWidget* parent = nullptr);
  void display(std::optional<InjectionState> state);
  QSize sizeHint() const override;
  QSize minimumSizeHint() const override { return sizeHint(); }

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  StepStrip strip_;
  std::optional<InjectionState> shown_;
};

}  // namespace microinjection
