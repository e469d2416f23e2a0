#include "rviz/offer_row.h"

#include "rviz/colours.h"

namespace microinjection {

OfferRow::OfferRow(const QString& name, int lines, QWidget* parent, QGridLayout* layout, int line,
                   const std::function<void()>& pressed)
    : button_(new OfferButton(name, parent, pressed)), text_(new ElidedLabel(lines, parent)) {
  button_->setFixedSize(86, 28);
  text_->setColour(QColor(kMutedColour));
  layout->addWidget(button_, line, 0);
  layout->addWidget(text_, line, 1);
}

void OfferRow::display(bool offered, const std::string& text) {
  button_->offer(offered);
  text_->setColour(offered ? text_->palette().color(QPalette::WindowText) : QColor(kMutedColour));
  text_->setText(QString::fromStdString(text));
}

}  // namespace microinjection
