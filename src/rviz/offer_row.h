#pragma once

#include <QGridLayout>
#include <functional>

#include "operation/console/console_commands.h"
#include "rviz/elided_label.h"
#include "rviz/offer_button.h"

namespace microinjection {

/// A button, and beside it what it does or why it is greyed.
class OfferRow {
 public:
  /// Adds both to a line of the layout of `parent`. `lines`: of the text.
  OfferRow(const QString& name, int lines, QWidget* parent, QGridLayout* layout, int line,
           const std::function<void()>& pressed);
  void display(bool offered, const std::string& text);
  /// Its effect, or the reason for the refusal.
  void display(const CommandOffer& offer) {
    display(offer.refusal.empty(), offer.refusal.empty() ? offer.effect : offer.refusal);
  }

 private:
  OfferButton* button_;
  ElidedLabel* text_;
};

}  // namespace microinjection
