#pragma once

#include <QComboBox>
#include <QWidget>
#include <functional>
#include <string>
#include <vector>

#include "rviz/elided_label.h"
#include "rviz/offer_button.h"

namespace microinjection {

/// A line with buttons for steps, the choice of a step's length, and what they do or why they are greyed.
class JogRow : public QWidget {
 public:
  /// Called with the number of the button that was pressed.
  using Pressed = std::function<void(std::size_t button)>;

  /// @param steps  m, from which the user chooses; the second one is chosen at first
  JogRow(const QString& name, const std::vector<const char*>& buttons, const std::vector<double>& steps,
         const Pressed& pressed, QWidget* parent = nullptr);
  double step() const;  ///< m, chosen
  void offer(std::size_t button, bool offered) { buttons_[button]->offer(offered); }
  /// `muted`: it is a reason.
  void setText(const std::string& text, bool muted);

 private:
  std::vector<OfferButton*> buttons_;
  QComboBox* steps_;
  ElidedLabel* text_;
};

}  // namespace microinjection
