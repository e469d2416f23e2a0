#pragma once

#include <memory>
#include <optional>
#include <string>

#include "rig/injector/injector_device.h"
#include "rig/injector/injector_model.h"
#include "rig/injector/injector_protocol.h"
#include "rig/injector/line_dialogue.h"
#include "rig/serial/wire.h"

namespace microinjection {

/// A real injector behind InjectorProtocol. One command at a time, each line of it with its reply.
///
/// A pulse is under way when the reply to its last line, the trigger, has accepted it. One that is refused before is
/// not triggered. A trigger is sent once: when no good reply comes, nobody knows whether the pulse was done, which is a
/// fault until reset(), and as long as it would last. A balance pressure, which does no harm twice, is sent again; of
/// those that wait, the newest wins. A stop takes back a pulse that was not triggered yet; otherwise, where the
/// protocol has lines for it, it goes before everything else, and is sent again as a balance pressure is. A pulse
/// during which this program or its stop guard stood still is broken off, which is a fault; without a guard there is no
/// pulse.
///
/// Where pulses are timed from here, the stop ends them, too. It is sent again and again until the device has accepted
/// it, also after the line was opened, and until then there is no pulse: an output may be on.
///
/// Flow and volume are estimates by the model of the pipette and the device's rise time. So is the pressure until it
/// has been asked for since it changed last: what was queried before is of another pulse, or of none.
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
  std::string fault() const override;

  unsigned badReplies() const { return bad_replies_ + dialogue_.badLines(); }

 private:
  enum class Task { kNone, kBegin, kPulse, kBalance, kStop, kQuery };
  enum class Refusal { kNo, kYes };

  const InjectorProtocol::Exchanges& exchanges(Task task) const;
  bool triggered() const;
  std::string unsure() const;
  bool mayFlow() const;
  bool stopping() const { return waiting_stop_ || task_ == Task::kStop; }
  void checkGuard(double time);
  bool keepOpen(double time);
  void keepStopped(double time);
  void receive(double time);
  void take(const std::string& reply);
  void complete();
  void abort(const std::string& why, Refusal refusal = Refusal::kNo);
  void giveUpPulse(const std::string& why, bool was_triggered, Refusal refusal);
  void fail(const std::string& why);
  void talk(double time);
  void putBack();
  bool begin(Task task);
  bool next(double time);
  void pressureChanges();
  void takePressure(double queried);
  void report();

  std::unique_ptr<Wire> wire_;
  InjectorProtocol protocol_;
  InjectorLimits limits_;
  InjectorModel model_;
  LineDialogue dialogue_;
  std::string first_stop_;        ///< line that ends a pulse, back to the balance pressure of the start
  double time_ = 0;               ///< s, of the last step
  double tried_ = -1e9;           ///< s, when the line was last tried
  Task task_ = Task::kNone;       ///< the present command
  std::size_t step_ = 0;          ///< its exchange that is under way or next
  InjectorProtocol::Values say_;  ///< its numbers
  bool waiting_begin_ = false;
  double asked_ = -1e9;  ///< s, of the last query
  std::optional<InjectionPulse> waiting_pulse_;
  double waits_since_ = 0;                    ///< s
  std::optional<InjectionPulse> sent_pulse_;  ///< that is set up or triggered, and not accepted yet
  bool waiting_stop_ = false;
  bool over_ = false;                      ///< the stop is the end of a timed pulse whose time is over
  bool stopped_ = false;                   ///< the device has accepted a stop since the line was opened
  double stop_failed_ = -1e9;              ///< s, when a stop was last given up
  double ends_ = 0;                        ///< s, of the present pulse
  double last_sent_ = 0;                   ///< s, when the last line was sent
  double unsure_until_ = -1e9;             ///< s, end of a pulse that may be under way although nobody has accepted it
  bool balance_known_ = false;             ///< the device has accepted the one that was sent last
  std::optional<double> waiting_balance_;  ///< Pa
  double sent_balance_ = 0;                ///< Pa
  int tries_ = 0;                          ///< of the present stop, balance or query without a good reply
  double settling_;                        ///< s, until the regulator's response has died away
  double changed_ = -1e9;                  ///< s, when a pulse, its end or a new balance changed the pressure last
  std::optional<double> pressure_;         ///< Pa, as queried since then
  unsigned bad_replies_ = 0;
  std::string fault_;                                 ///< until reset()
  std::string trouble_ = "the line is not open yet";  ///< while it lasts
  std::string unguarded_;                             ///< why there is no stop guard, while it lasts
  InjectorReading reading_;
};

}  // namespace microinjection
