#pragma once

#include <QColor>
#include <QString>

#include "operation/console/light.h"

namespace microinjection {

// The console's colours. Lamps differ in lightness, too, and always have a text beside them.
inline QColor colourOf(Light light) {
  switch (light) {
    case Light::kGreen:
      return {0x2e, 0x9e, 0x4f};
    case Light::kYellow:
      return {0xf2, 0xb1, 0x0e};
    case Light::kRed:
      return {0xd0, 0x2c, 0x2c};
    case Light::kGrey:
      break;
  }
  return {0xa8, 0xad, 0xb3};
}

constexpr QRgb kOfferedColour = 0xff2b6cb0;    ///< a button that can be pressed, and the present step
constexpr QRgb kPassedColour = 0xffbcd3ea;     ///< a step that was passed
constexpr QRgb kRefusedColour = 0xffd5d8dc;    ///< a greyed button, and a step ahead
constexpr QRgb kStopColour = 0xffc62828;       ///< the stop button
constexpr QRgb kMutedColour = 0xff6b7178;      ///< text of what is not offered
constexpr QRgb kPredictedColour = 0xff1f77b4;  ///< lines
constexpr QRgb kMeasuredColour = 0xffe07b00;
constexpr QRgb kPastColour = 0xffb8bcc2;
constexpr QRgb kPastTextColour = 0xff858b92;  ///< the same, readable
constexpr QRgb kGuardColour = 0xffd02c2c;     ///< limits
constexpr QRgb kPunctureColour = 0xff7b3fa0;  ///< the expected one

/// The style sheet of a button. `more`: declarations of its own.
inline QString buttonStyle(QRgb fill, QRgb text, const char* more = "") {
  const QColor colour(fill);
  return QString(
             "QPushButton { background: %1; color: %2; border: none; border-radius: 4px; padding: 3px 8px; %3 }"
             "QPushButton:pressed { background: %4; }")
      .arg(colour.name(), QColor(text).name(), more, colour.darker(130).name());
}

/// Of a button that is offered, or is greyed.
inline QString offerStyle(bool offered) {
  return offered ? buttonStyle(kOfferedColour, 0xffffffff) : buttonStyle(kRefusedColour, kMutedColour);
}

}  // namespace microinjection
