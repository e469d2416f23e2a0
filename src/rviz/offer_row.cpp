#include "rviz/offer_row.h"

#include "rviz/button_style.h"

namespace microinjection {

OfferRow::OfferRow(const QString& name, int lines, QWidget* parent, QGridLayout* layout, int line,
                   const std::function<void()>& pressed)
    : button_(new QPushButton(name, parent)), text_(new ElidedLabel(lines, parent)) {
  button_->setFocusPolicy(Qt::NoFocus);  // a focused button would take the space bar
  button_->setFixedSize(86, 28);
  button_->setStyleSheet(offerStyle(false));
  button_->setEnabled(false);
  text_->setColour(QColor(kMutedColour));
  layout->addWidget(button_, line, 0);
  layout->addWidget(text_, line, 1);
  QObject::connect(button_, &QPushButton::clicked, parent, pressed);
}

void OfferRow::display(bool offered, const std::string& text) {
  if (offered != offered_) {
    offered_ = offered;
    button_->setEnabled(offered);
    button_->setStyleSheet(offerStyle(offered));
    text_->setColour(offered ? text_->palette().color(QPalette::WindowText) : QColor(kMutedColour));
  }
  text_->setText(QString::fromStdString(text));
}

}  // namespace microinjection
