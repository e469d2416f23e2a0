#pragma once

#include <QColor>
#include <QString>

#include "rviz/colours.h"

namespace microinjection {

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
