#pragma once

#include <boost/circular_buffer.hpp>
#include <optional>
#include <string>

#include "base/config_reader.h"

namespace microinjection {

/// What the controller knows of the noise of its witnesses, and what it waits for.
struct BreakDetectionConfig {
  double interface_noise = 0.15e-6;  ///< m, standard deviation of an interface in an image
  double interface_speed = 20e-6;    ///< m/s, of an interface that cytoplasm moves
  double flow_noise = 0;             ///< m^3/s, of the injector's flow; 0: its flow is not measured
  double flow_change = 0.5e-15;      ///< m^3/s, that flows in when the membrane is broken
  double false_rate = 1e-7;          ///< false alarms a sample, of each witness
  double fall = 0.25;                ///< smallest share of the force that falls at once
  double settle = 0.12;              ///< s, of a tongue that springs back when the suction ends
  double confirm = 0.1;              ///< s, over which the witnesses are then asked again

  static BreakDetectionConfig read(ConfigReader& reader);
};

/// Page's cumulative sum for a lasting rise above a baseline that follows slowly ("Continuous inspection schemes",
/// Biometrika 1954); see ContactDetector.
class RiseDetector {
 public:
  /// @param deviation of a value, > 0; @param change to detect, > 0; @param false_rate a sample, in (0, 0.01)
  RiseDetector(double deviation, double change, double false_rate);
  bool step(double value);  ///< returns whether it has risen
  void reset() { sum_ = 0; }

 private:
  double deviation_, allowance_, limit_;
  double baseline_ = 0, sum_ = 0;
  long count_ = 0;
};

/// A fall of a force within a few tens of milliseconds, while the needle rests: a relaxing cell's is slower. Of the
/// means of 8 samples that are 32 samples apart, the later one is lower by more than noise and a share of the force.
class FallDetector {
 public:
  static constexpr int kMean = 8, kApart = 32;  ///< samples
  /// @param deviation N, of a sample; @param share of the force, in (0, 1); @param false_rate a sample, in (0, 0.01)
  FallDetector(double deviation, double share, double false_rate);
  bool step(double force);  ///< N; returns whether it has fallen
  bool isReady() const { return recent_.full(); }
  bool couldFall() const;  ///< the force is large enough for a fall to be seen
  double before() const;   ///< N, mean before the fall; @pre 40 samples
  double now() const;      ///< N, mean of the last 8; @pre 8 samples
  void reset() { recent_.clear(); }

 private:
  double mean(int begin) const;

  double smallest_, share_;
  boost::circular_buffer<double> recent_{kMean + kApart};
};

/// Where the image shows the interface of what the needle has drawn in.
struct InterfaceReading {
  double position = 0;  ///< m from the mouth, into the bore
  bool is_new = true;   ///< another image than that of the last step
};

/// Tells a membrane that breaks under suction from one that is only drawn in. Three witnesses, of which each may be
/// absent, and each with its own rate of false alarms:
///
///     force      of the dent falls to that of the shaft       FallDetector
///     image      the interface runs into the bore             RiseDetector of its advance between two images
///     flow       of the injector, if it measures it           RiseDetector
///
/// The first alarm ends the suction at once: to stop costs nothing. Then the witnesses are asked again, because only a
/// tongue springs back: an interface that stays in, or a force that stays down, is a break. An image in which the
/// interface has moved decides against the force.
class BreakDetector {
 public:
  /// `force_noise`: N, standard deviation of a reading.
  BreakDetector(const BreakDetectionConfig& config, double force_noise);

  /// Of a step with suction, dt (s) after the last. `force`: N, along the pipette above the offset, of a new reading;
  /// `flow`: m^3/s, into the needle. Returns the witness that alarms; empty: none does.
  std::string watch(const std::optional<double>& force, const std::optional<InterfaceReading>& interface,
                    const std::optional<double>& flow, double dt);

  /// Of what the witnesses say after the suction has ended. Nothing that is heard is no sign of a whole membrane.
  enum class Verdict { kBroken, kWhole, kUnknown };
  /// Of a step after the suction has ended, with the same readings. Empty: it is too early to tell.
  std::optional<Verdict> confirm(const std::optional<double>& force, const std::optional<InterfaceReading>& interface,
                                 double dt);
  /// Whether a break could be told by what has been watched so far: the force is above its noise, an image has shown
  /// the interface, or the flow is measured.
  bool canTell() const;
  bool knowsForce() const { return force_.isReady(); }  ///< has enough readings to see a fall
  void resume();                                        ///< the alarm was false: the suction goes on

 private:
  struct Mean {
    double sum = 0;
    int count = 0;
    void add(double value) {
      sum += value;
      ++count;
    }
    double value() const { return sum / count; }
  };

  BreakDetectionConfig config_;
  double force_noise_;
  FallDetector force_;
  RiseDetector interface_, flow_;
  double since_image_ = 0;      ///< s
  std::optional<double> last_;  ///< m, of the interface
  Mean rest_, alarm_;           ///< m, of the interface before it moved, and when the alarm was
  bool force_alarmed_ = false, image_alarmed_ = false;
  double before_ = 0, fallen_ = 0;  ///< N, of the force about its alarm
  double confirming_ = 0;           ///< s
  Mean force_after_, interface_after_;
};

}  // namespace microinjection
