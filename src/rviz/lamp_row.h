#pragma once

#include <QLabel>
#include <QWidget>

#include "operation/console/light.h"
#include "rviz/elided_label.h"

namespace microinjection {

/// A lamp, its name and its reason.
class LampRow : public QWidget {
 public:
  /// `name`: empty for none; `lines`: of the reason.
  LampRow(const QString& name, int lines, QWidget* parent = nullptr);
  void display(const Lamp& lamp);

 private:
  class Dot : public QWidget {
   public:
    explicit Dot(QWidget* parent);
    void setLight(Light light);

   protected:
    void paintEvent(QPaintEvent* event) override;

   private:
    Light light_ = Light::kGrey;
  };
  Dot* dot_;
  ElidedLabel* text_;
};

}  // namespace microinjection
