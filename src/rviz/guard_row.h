#pragma once

#include <QString>
#include <QWidget>

#include "operation/console/guard_margins.h"

namespace microinjection {

/// A bar that fills up to a guard's limit, with its value and limit.
class GuardRow : public QWidget {
 public:
  /// `name`, `text`: the longest that it shows.
  explicit GuardRow(QWidget* parent = nullptr, QString name = "Estimate ", QString text = "00.00 of 00.0 uN ");
  void display(const GuardMargin& margin);
  QSize sizeHint() const override { return {150, 20}; }
  QSize minimumSizeHint() const override { return sizeHint(); }

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  QString longest_name_, longest_text_;
  GuardMargin margin_;
};

}  // namespace microinjection
