#pragma once

#include <string>
#include <vector>

#include "base/config_errors.h"
#include "base/config_reader.h"

namespace microinjection {

/// How a membrane gives way to the suction of a needle's bore: a scene's aspiration, of one layer.
///
/// Embryologists distinguish by how much pricking and suction an oolemma breaks (Nagy and others, Hum Reprod 10, 3171,
/// 1995: 20 % of 6860 by one prick without suction, 40 % with a small and 34 % with a long suction, 6 % by more than
/// one prick):
///
///     it breaks                    scene
///     before aspiration            no aspiration: the layer's force, depth or strain alone
///     at its beginning             mode at: as soon as it closes the bore
///     during it                    mode during: by its tension
///     after it                     mode after: the tension weakens it; when it falls, the needle breaks it
///     not                          mode none
///
/// By tension, a membrane under the tension T lives tension_time * exp(-(T - tension) / tension_scale): pores form the
/// faster, the larger the tension (Evans, Heinrich, Ludwig and Rawicz, "Dynamic tension spectroscopy and strength of
/// biomembranes", Biophys J 2003). So it breaks at a higher tension when the suction grows faster. Of the life's
/// distribution the mean is taken. All figures are illustrative: nobody has measured an oolemma's so.
struct AspirationConfig {
  std::string mode = "during";  ///< one of modes()
  double tension = 1e-3;        ///< N/m, under which it lives `tension_time`; without a scale, at which it breaks
  double tension_scale = 0;     ///< N/m; 0: whatever the rate
  double tension_time = 1;      ///< s
  double weakened = 0.3;        ///< share of the layer's limits that mode after leaves

  static const std::vector<std::string>& modes();  ///< at, during, after, none
  static AspirationConfig read(ConfigReader reader);
  /// Adds the errors of this configuration; `path` ends with a slash.
  void check(const std::string& path, ConfigErrors& errors) const;
};

/// A membrane over the mouth of an aspirating needle, and what the suction has done to it so far.
class AspiratedMembrane {
 public:
  explicit AspiratedMembrane(const AspirationConfig& config) : config_(config) {}

  /// @param tension  N/m, of the membrane that closes the bore, for dt (s); 0: it is not drawn in
  /// @returns whether it breaks now
  bool step(double tension, double dt);
  /// Share of the layer's limits that the needle still meets.
  double strength() const { return over_ && spent_ >= 1 ? config_.weakened : 1; }

 private:
  AspirationConfig config_;
  double spent_ = 0;   ///< of its life
  bool over_ = false;  ///< the suction has ended
};

}  // namespace microinjection
