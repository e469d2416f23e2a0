#include "cell/identification/drag.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "cell/identification/contact_guess.h"

namespace microinjection {
namespace {

/// A needle that goes 20 um in and out through a medium whose drag grows with the speed.
struct Way {
  double drag = 30e-12, drift = 0, noise = 5e-12;  ///< N on the way in, N/s, N
  double slow = 0.3;                               ///< speed over the last tenth of the way in, as a share
  double stiffness = 0;                            ///< N/m^1.5, of a cell 2 um before the deepest place

  ForceCurve make() const {
    constexpr double kDeep = 20e-6, kStep = 5e-9, kPeriod = 1e-3, kCell = 18e-6;
    std::mt19937 random(3);
    std::normal_distribution<double> off(0, noise);
    ForceCurve curve;
    double position = 0, speed = 1;
    while (position >= 0) {
      if (speed > 0) speed = position > 0.9 * kDeep ? slow : 1;
      if (position >= kDeep) speed = -1;
      position += speed * kStep;
      const double depth = std::max(0.0, position - kCell);
      const double time = curve.size() * kPeriod;
      curve.time.push_back(time);
      curve.position.push_back(position);
      curve.force.push_back(-drag * speed + drift * time + stiffness * std::pow(depth, 1.5) + off(random));
    }
    return curve;
  }
};

ContactGuess guessOf(const ForceCurve& whole) {
  ForceCurve in = whole;
  in.drag = dragOf(whole);
  const auto turn = std::max_element(in.position.begin(), in.position.end()) - in.position.begin();
  for (std::vector<double>* values : {&in.time, &in.position, &in.force}) values->resize(turn);
  return guessContact(in, true);
}

TEST(Drag, IsTheDifferenceOfTheWaysInAndOut) {
  for (const double drift : {0.0, 20e-12}) {
    Way way;
    way.drift = drift;
    way.noise = 0.5e-12;  // three deviations are taken off
    EXPECT_NEAR(dragOf(way.make()), 2 * way.drag, 0.1 * way.drag) << drift;
  }
}

TEST(Drag, IsNoneWithoutAWayOut) {
  ForceCurve curve = Way().make();
  for (std::vector<double>* values : {&curve.time, &curve.position, &curve.force}) values->resize(4000);
  EXPECT_EQ(dragOf(curve), 0);
}

TEST(Drag, ANeedleThatBecomesSlowIsNoContact) {
  const ContactGuess guess = guessOf(Way().make());
  EXPECT_FALSE(guess.touched);
  EXPECT_NE(guess.reason.find("ways in and out"), std::string::npos) << guess.reason;
}

TEST(Drag, ACellIsFoundBesideIt) {
  Way way;
  way.slow = 1;
  way.stiffness = 0.3e-9 / std::pow(2e-6, 1.5);
  const ContactGuess guess = guessOf(way.make());
  EXPECT_TRUE(guess.touched) << guess.reason;
  EXPECT_NEAR(guess.contact, 18e-6, 0.3e-6);
}

}  // namespace
}  // namespace microinjection
