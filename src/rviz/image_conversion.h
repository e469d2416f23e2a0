#pragma once

#include <sensor_msgs/Image.h>

#include <QImage>
#include <QString>

namespace microinjection {

/// The picture of a message: grey, colour or Bayer, of 8 or 16 bits. A picture of 16 bits is
/// stretched from its darkest to its brightest value. Null with the reason in `defect` for a message
/// that cannot be read.
QImage toPicture(const sensor_msgs::Image& message, QString& defect);

}  // namespace microinjection
