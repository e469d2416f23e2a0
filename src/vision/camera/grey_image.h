#pragma once

#include <opencv2/core/mat.hpp>

namespace microinjection {

/// Grey levels of an image that become black and white.
struct GreyRange {
  double low = 0;   ///< grey levels
  double high = 0;  ///< grey levels
};

/// Returns a frame as grey of its own depth (CV_8U or CV_16U). Colour (BGR, BGRA) is weighted as in
/// ITU-R BT.601; transparency is dropped. Throws cv::Exception for another depth or number of
/// channels.
cv::Mat toGrey(const cv::Mat& frame);

/// Levels below which and above which lie `tail` of the pixels, tail in [0, 0.5). A hot pixel does
/// not move them. Of a grey image of 8 or 16 bit, sampled on a grid of up to about 256 x 256 pixels.
GreyRange greyRange(const cv::Mat& grey, double tail = 0.001);

/// A frame of any depth and colour as CV_8U. 0 is the low and 255 the high end of its range; values beyond are cut. A
/// frame of one level becomes grey.
cv::Mat toGrey8(const cv::Mat& frame, double tail = 0.001);

}  // namespace microinjection
