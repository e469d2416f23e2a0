#include "rviz/offer_button.h"

#include "rviz/colours.h"

namespace microinjection {

OfferButton::OfferButton(const QString& name, QWidget* parent, const std::function<void()>& pressed)
    : QPushButton(name, parent) {
  setFocusPolicy(Qt::NoFocus);  // a focused button would take the space bar
  setStyleSheet(offerStyle(false));
  setEnabled(false);
  QObject::connect(this, &QPushButton::clicked, parent, pressed);
}

void OfferButton::offer(bool offered) {
  if (offered == offered_ || isDown()) return;
  offered_ = offered;
  setEnabled(offered);
  setStyleSheet(offerStyle(offered));
}

}  // namespace microinjection
