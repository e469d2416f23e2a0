#pragma once

#include <QGridLayout>
#include <QLabel>
#include <QWidget>
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

/// The grid of a box of the console: a title above, buttons in the first column, what they have to say in the second.
inline QGridLayout* boxLayout(QWidget* box, const char* title) {
  auto* layout = new QGridLayout(box);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->setHorizontalSpacing(8);
  layout->setVerticalSpacing(1);
  layout->setColumnStretch(1, 1);
  layout->addWidget(new QLabel(QString("<b>%1</b>").arg(title), box), 0, 0, 1, 2);
  return layout;
}

}  // namespace microinjection
