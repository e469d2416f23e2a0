#pragma once

#include <memory>
#include <optional>
#include <string>

#include "injector/injector_device.h"
#include "injector/injector_model.h"
#include "injector/injector_protocol.h"
#include "serial/line_splitter.h"
#include "serial/wire.h"

namespace microinjection {

/// A real injector behind InjectorProtocol. One exchange at a time: a command is sent, its reply awaited.
///
/// A pulse is sent once. When no good reply comes, nobody knows whether it was done: that is a fault until reset(), and
/// it is not sent again. A balance pressure, which does no harm twice, is; of those that wait, the newest wins. After a
/// reply that was late or wrong, nothing is sent before the line has been quiet for a while, so that a late reply is
/// not taken for the next one. A stop takes back a pulse that was not sent yet; otherwise, where the protocol has a
/// line for it, it goes before everything else, and is sent again as a balance pressure is. A pulse during which this
/// program or its stop guard stood still is broken off, which is a fault; without a guard there is no pulse. Flow and
/// volume are estimates by the model of the pipette and the device's rise time.
class SerialInjector : public InjectorDevice {
 public:
  /// `model`: pipette, limits and the device's rise time; its balance pressure is sent at the start.
  SerialInjector(std::unique_ptr<Wire> wire, const InjectorProtocol& protocol, const InjectorModelConfig& model);
  ~SerialInjector() override;  ///< ends a pulse that may be under way

  std::string pulse(const InjectionPulse& pulse) override;
  std::string setBalance(double pressure) override;
  std::string stop() override;
  void reset() override;
  void step(double time) override;
  const InjectorReading& reading() const override { return reading_; }
  std::string fault() const override { return !fault_.empty() ? fault_ : !unguarded_.empty() ? unguarded_ : trouble_; }

  unsigned badReplies() const { return bad_replies_ + lines_.tooLong(); }

 private:
  enum class Exchange { kNone, kPulse, kBalance, kStop, kQuery };

  bool mayFlow() const;
  bool keepOpen(double time);
  void checkGuard(double time);
  void listen(double time);
  void take(const std::string& reply);
  void complete(const std::string& reply);
  void talk(double time);
  void send(Exchange exchange, const std::string& line, double timeout, double time);
  void giveUp(const std::string& why);
  void fail(const std::string& why);
  void report();

  std::unique_ptr<Wire> wire_;
  InjectorProtocol protocol_;
  InjectorLimits limits_;
  InjectorModel model_;
  LineSplitter lines_;
  double time_ = 0;      ///< s, of the last step
  double tried_ = -1e9;  ///< s, when the line was last tried
  Exchange exchange_ = Exchange::kNone;
  double deadline_ = 0;   ///< s, of the reply
  bool in_step_ = false;  ///< no reply is owed
  double heard_ = 0;      ///< s, when the last byte came while out of step
  double asked_ = -1e9;   ///< s, of the last query
  std::optional<InjectionPulse> waiting_pulse_;
  double waits_since_ = 0;  ///< s
  std::optional<InjectionPulse> sent_pulse_;
  bool waiting_stop_ = false;
  std::optional<double> waiting_balance_;  ///< Pa
  double sent_balance_ = 0;                ///< Pa
  int tries_ = 0;                          ///< of the present stop, balance or query without a good reply
  std::optional<double> pressure_;         ///< Pa, as queried
  unsigned bad_replies_ = 0;
  std::string fault_;                                 ///< until reset()
  std::string trouble_ = "the line is not open yet";  ///< while it lasts
  std::string unguarded_;                             ///< why there is no stop guard, while it lasts
  InjectorReading reading_;
};

}  // namespace microinjection
