#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "hardware/injector/injector_device.h"
#include "hardware/injector/injector_model.h"
#include "hardware/injector/injector_protocol.h"
#include "hardware/injector/line_dialogue.h"
#include "hardware/serial/wire.h"

namespace microinjection {

/// Driver of a real injector with an InjectorProtocol. It executes one command at a time, and waits for the reply to
/// each line.
///
///     pulse() --> waits --> set up, line by line --> trigger, once --> accepted --> model runs --> verified --> counts
///                   |               |                     |                             |              |
///                no free line    refused:            no valid reply:            guard:           not confirmed:
///                in time         not triggered       may have been done         broken off       dose unknown
///                   '---------------'---------------------'-----------------------------'--------------'--> fault
///
/// One rule decides all cases: what has been injected is known, or a fault says that it is not. A command without a
/// reply could be sent again, as is usual; for a trigger that would inject twice into one cell. So a trigger is sent
/// once. Without a valid reply it is unknown whether the pulse was executed, which is a fault until reset(), and at
/// least as long as the pulse would last. A balance pressure can be repeated safely and is sent again; of several
/// pending ones only the newest is sent.
///
/// A stop cancels a pulse that was not triggered yet. Otherwise, if the protocol has lines for it, a stop precedes
/// all other commands and is repeated as a balance pressure is. A pulse during which this program or its stop guard
/// was frozen is aborted, which is a fault. Without a guard there is no pulse.
///
/// If this driver times the pulses (InjectorProtocol::timed), a stop ends each of them. It is repeated until the
/// device accepts it, also after the line was opened. Until then there is no pulse, since an output may be on.
///
/// A pulse with lines to verify it counts as completed when they confirm, after its end, that the device was set as
/// before: somebody may have turned its knob meanwhile.
///
/// Flow and volume are estimates from the model of the pipette and the device's rise time, because no protocol here
/// reports them. So is the pressure until it has been queried after its last change. While the device does not
/// answer, the pressure is unknown and the volume does not grow; it leaves out pulses whose dose is unknown.
class SerialInjector : public InjectorDevice {
 public:
  /// kKeep: the device keeps the pressure that it has until another one is commanded. For a holder: a driver that
  /// begins anew must not let go of the cell.
  enum class Start { kSendBalance, kKeep };

  /// `model`: pipette, limits and the device's rise time; its balance pressure is sent at the
  /// start.
  SerialInjector(std::unique_ptr<Wire> wire, const InjectorProtocol& protocol, const InjectorModelConfig& model,
                 Start start = Start::kSendBalance);
  ~SerialInjector() override;  ///< ends a pulse that may be in progress

  std::string pulse(const InjectionPulse& pulse) override;
  std::string setBalance(double pressure) override;
  std::string stop() override;
  void reset() override;
  void step(double time) override;
  const InjectorReading& reading() const override { return reading_; }
  std::string fault() const override;

  /// Whether the device has said its pressure, or has accepted the one that reading() estimates.
  bool pressureKnown() const { return fault().empty() && (pressure_ || (commanded_ && balance_confirmed_)); }
  unsigned badReplies() const { return bad_replies_ + dialogue_.badLines(); }

 private:
  enum class Task { kNone, kBegin, kPulse, kVerify, kBalance, kStop, kQuery };
  enum class Refusal { kNo, kYes };
  static constexpr int kTries = 3;  // of commands that may be repeated

  const InjectorProtocol::Exchanges& exchanges(Task task) const;
  bool triggered() const;
  std::string unconfirmedReason() const;
  bool mayFlow() const;
  void stepModel(double time);
  void endDrawing(bool by_pulse);
  void repeatBalance();
  void giveUpVerification(const std::string& reason);
  bool stopping() const { return waiting_stop_ || task_ == Task::kStop; }
  void checkGuard(double time);
  bool keepOpen(double time);
  void keepStopped(double time);
  void receive(double time);
  void handleReply(const std::string& reply);
  void complete();
  void abort(const std::string& reason, Refusal refusal = Refusal::kNo);
  void giveUpPulse(const std::string& reason, bool was_triggered, Refusal refusal);
  void fail(const std::string& reason);
  void sendNext(double time);
  void putBack();
  bool begin(Task task);
  bool next(double time);
  void pressureChanges();
  void updatePressure(double queried);
  void report();

  std::unique_ptr<Wire> wire_;
  InjectorProtocol protocol_;
  InjectorLimits limits_;
  InjectorModel model_;
  LineDialogue dialogue_;
  std::string first_stop_;           ///< line that ends a pulse and returns to the initial balance pressure
  double time_ = 0;                  ///< s, of the last step
  double last_attempt_ = -1e9;       ///< s, of the last attempt to open the line
  Task task_ = Task::kNone;          ///< the present command
  std::size_t step_ = 0;             ///< index of its present or next exchange
  InjectorProtocol::Values values_;  ///< values of its placeholders
  std::size_t count_ = 0;            ///< of the last sent line, in kCounts
  bool waiting_begin_ = false;
  double last_query_ = -1e9;  ///< s, of the last query
  std::optional<InjectionPulse> waiting_pulse_;
  double pulse_wait_start_ = 0;               ///< s
  std::optional<InjectionPulse> sent_pulse_;  ///< set up or triggered, and not accepted yet
  struct Unverified {
    InjectionPulse pulse;
    double volume;   ///< m^3, reported at its start
    double longest;  ///< s, when it is over at the latest, by what was read back
  };
  std::optional<Unverified> unverified_;  ///< the accepted pulse, until it is verified
  bool waiting_verify_ = false;
  bool waiting_stop_ = false;
  bool over_ = false;                      ///< the stop ends a timed pulse whose duration is over
  bool stopped_ = false;                   ///< the device has accepted a stop since the line was opened
  double stop_failed_ = -1e9;              ///< s, of the last stop that failed
  double ends_ = 0;                        ///< s, end of the present pulse
  double last_sent_ = 0;                   ///< s, of the last sent line
  double unconfirmed_until_ = -1e9;        ///< s, end of a pulse that may run without being accepted
  std::optional<double> unanswered_;       ///< s, that it may last from the next line on, until one is answered
  bool commanded_;                         ///< it has been told a balance pressure, or will be at the start
  bool balance_confirmed_ = false;         ///< the device has accepted the last one sent
  std::optional<double> waiting_balance_;  ///< Pa
  double sent_balance_ = 0;                ///< Pa
  int tries_ = 0;                          ///< of the present stop or balance without a valid reply
  int query_tries_ = 0;                    ///< queries in a row without a valid reply; other commands may have one
  double settling_;                        ///< s, settling time of the regulator
  double changed_ = -1e9;                  ///< s, of the last pressure change by a pulse, its end or a new balance
  std::optional<double> pressure_;         ///< Pa, as queried since then
  unsigned bad_replies_ = 0;
  double volume_ = 0;                                    ///< m^3, while the pressure was known
  unsigned seen_ = 0, done_ = 0;                         ///< pulses of the model, and those that count
  std::uint64_t last_id_ = 0;                            ///< of the last that counts
  std::uint64_t given_up_ = 0;                           ///< of the last that could not be verified
  std::string fault_;                                    ///< until reset()
  std::string error_text_ = "the line is not open yet";  ///< of the line or a query; empty: none
  std::string unguarded_;                                ///< why there is no stop guard; empty: there is one
  InjectorReading reading_;
};

}  // namespace microinjection
