#include "cell/estimation/image_contact.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace microinjection {
namespace {

constexpr double kRadius = 37e-6, kHeight = 0.8e-6, kDeviation = 0.1e-6;

ImageContact images(int count, double beside = 0) {
  ImageContact contact({}, kRadius);
  std::mt19937 random(5);
  std::normal_distribution<double> off(0, kDeviation);
  for (int i = 0; i < count; ++i) {
    const double depth = 1e-6 + 0.2e-6 * i, surface = std::sqrt(kRadius * kRadius - beside * beside) + kHeight;
    contact.add({beside, 0, surface - depth}, depth + off(random), kDeviation);
  }
  return contact;
}

TEST(ImageContact, IsTheTipsHeightAndTheDimplesDepth) {
  for (const double beside : {0.0, 10e-6}) {
    const auto height = images(15, beside).height();
    ASSERT_TRUE(height);
    EXPECT_NEAR(height->value, kHeight, 0.1e-6);
    EXPECT_GT(height->deviation, ImageContactConfig().shared_error);
    EXPECT_LT(height->deviation, ImageContactConfig().shared_error + kDeviation);
  }
}

TEST(ImageContact, AboveTheCellItIsTheTipsHeightLessTheGap) {
  ImageContact contact({}, kRadius);
  for (int i = 1; i < 6; ++i) contact.add({0, 0, kRadius + kHeight + 1e-6 * i}, -1e-6 * i, kDeviation);
  ASSERT_TRUE(contact.height());
  EXPECT_NEAR(contact.height()->value, kHeight, 1e-12);
}

TEST(ImageContact, NeedsSomeImages) {
  EXPECT_FALSE(images(ImageContactConfig().least_images - 1).height());
  EXPECT_TRUE(images(ImageContactConfig().least_images).height());
}

TEST(ImageContact, OneBadImageOfManyDoesNotCount) {
  ImageContact contact = images(14);
  const double before = contact.height()->value;
  contact.add({0, 0, kRadius}, 25e-6, kDeviation);
  EXPECT_NEAR(contact.height()->value, before, 0.05e-6);
}

TEST(ImageContact, ScatterWidensTheDeviation) {
  ImageContact contact({}, kRadius);
  for (int i = 0; i < 15; ++i) contact.add({0, 0, kRadius}, 1e-6 + 2e-6 * (i % 3), kDeviation);
  EXPECT_GT(contact.height()->deviation, 0.5e-6);
}

TEST(ImageContact, WhatIsNoDimpleDoesNotCount) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  ImageContact contact({}, kRadius);
  for (int i = 0; i < 5; ++i) {
    contact.add({0, 0, kRadius}, kNan, kDeviation);
    contact.add({0, 0, kRadius}, 1e-6, kNan);
    contact.add({0, 0, kRadius}, 1e-6, 0);
    contact.add({0, 0, kRadius}, 0, kDeviation);
    contact.add({0, 0, kRadius}, 200e-6, kDeviation);
    contact.add({0, 0, kRadius}, -200e-6, kDeviation);
    contact.add({0, 0, kNan}, 1e-6, kDeviation);
    contact.add({0.6 * kRadius, 0, 0.8 * kRadius}, 1e-6, kDeviation);
  }
  EXPECT_FALSE(contact.height());
}

}  // namespace
}  // namespace microinjection
