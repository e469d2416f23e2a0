#pragma once

#include <QPushButton>
#include <functional>

namespace microinjection {

/// A button that is offered (blue) or greyed. It starts greyed.
class OfferButton : public QPushButton {
 public:
  OfferButton(const QString& name, QWidget* parent, const std::function<void()>& pressed);
  /// Does nothing while the mouse holds the button down: Qt forgets a press whose button is greyed before the release.
  void offer(bool offered);

 private:
  bool offered_ = false;
};

}  // namespace microinjection
