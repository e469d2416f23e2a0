#include "injector/serial_injector.h"

#include <utility>

namespace microinjection {
namespace {

constexpr double kRetry = 1;               // s, between attempts to open the line
constexpr std::size_t kLongestLine = 256;  // bytes
constexpr int kTries = 3;                  // of what may be sent again

}  // namespace

SerialInjector::SerialInjector(std::unique_ptr<Wire> wire, const InjectorProtocol& protocol,
                               const InjectorModelConfig& model)
    : wire_(std::move(wire)),
      protocol_(protocol),
      limits_(model.limits),
      model_(model),
      lines_(protocol.terminator, kLongestLine),
      waiting_balance_(model.balance) {
  if (protocol_.stop) wire_->setGuardedStop(protocol_.stop->send.fill({}));  // a pulse must not outlive its node
}

SerialInjector::~SerialInjector() {
  if (protocol_.stop && mayFlow() && wire_->isOpen()) wire_->write(protocol_.stop->send.fill({}), time_);
}

/// A pulse whose reply went wrong may be under way as well.
bool SerialInjector::mayFlow() const { return sent_pulse_ || model_.reading().busy || !fault_.empty(); }

std::string SerialInjector::pulse(const InjectionPulse& pulse) {
  if (!fault().empty()) return fault();
  if (waiting_pulse_ || sent_pulse_ || model_.reading().busy) return "a pulse is under way";
  std::string asked = limits_.check(pulse);
  if (!asked.empty()) return asked;
  // What the device makes of it counts: a pulse of 0.4 ms is none at all where the line has whole milliseconds.
  const std::string sent = limits_.check(protocol_.asSent(pulse));
  if (!sent.empty()) return "in the digits of the device's line, " + sent;
  waiting_pulse_ = pulse;
  waits_since_ = time_;
  report();
  return "";
}

std::string SerialInjector::setBalance(double pressure) {
  if (!fault_.empty()) return fault_;
  std::string refusal = limits_.checkPressure("balance pressure", pressure);
  if (!refusal.empty()) return refusal;
  waiting_balance_ = pressure;
  tries_ = 0;
  return "";
}

std::string SerialInjector::stop() {
  waiting_pulse_.reset();
  const bool stopping = waiting_stop_ || exchange_ == Exchange::kStop;
  if (!protocol_.stop) {
    report();
    return mayFlow() ? "the protocol has no line for it" : "";
  }
  if (mayFlow() && !stopping) {
    waiting_stop_ = true;
    tries_ = 0;
  }
  report();
  return "";
}

void SerialInjector::reset() {
  fault_.clear();
  tries_ = 0;
  model_.reset();
  report();
}

void SerialInjector::step(double time) {
  time_ = time;
  checkGuard(time);  // before the model lets a pulse go on that the guard has ended
  model_.step(time);
  if (keepOpen(time)) {
    listen(time);
    if (wire_->isOpen()) talk(time);
  }
  report();
}

bool SerialInjector::keepOpen(double time) {
  if (wire_->isOpen()) return true;
  if (exchange_ != Exchange::kNone) giveUp("the line broke");
  if (waiting_pulse_) fail("the line broke");
  pressure_.reset();
  if (trouble_.empty()) trouble_ = "the line broke";
  if (time - tried_ < kRetry) return false;
  tried_ = time;
  trouble_ = wire_->open();
  if (!trouble_.empty()) return false;
  // The device may have been switched off meanwhile.
  if (!waiting_balance_) waiting_balance_ = sent_balance_;
  tries_ = 0;
  in_step_ = false;
  heard_ = time;
  return true;
}

/// The guard's stop has ended a pulse, or a guard that was lost cannot: either way the device is told to stop. What it
/// answered the guard is passed over as a late reply is.
void SerialInjector::checkGuard(double time) {
  const Wire::GuardReport guard = wire_->beat();
  unguarded_ = guard.missing.empty() ? "" : "no stop guard: " + guard.missing;
  if (guard.intervention.empty()) return;
  const bool flows = mayFlow();
  if (model_.reading().busy) fail("the pulse was broken off: " + guard.intervention);
  model_.stop();
  if (exchange_ != Exchange::kNone) giveUp(guard.intervention);
  if (waiting_pulse_) fail(guard.intervention);
  waiting_stop_ = waiting_stop_ || (flows && protocol_.stop);
  in_step_ = false;
  heard_ = time;
  tries_ = 0;
}

void SerialInjector::listen(double time) {
  const std::string bytes = wire_->read(time);
  if (!in_step_) {
    if (!bytes.empty()) heard_ = time;
    if (time - heard_ < protocol_.quiet) return;
    lines_.clear(false);
    in_step_ = true;
    return;
  }
  for (const std::string& reply : lines_.feed(bytes)) take(reply);
  if (exchange_ != Exchange::kNone && time > deadline_) giveUp("no good reply in time");
  if (!in_step_) heard_ = time;
}

void SerialInjector::take(const std::string& reply) {
  if (!in_step_) return;
  if (exchange_ == Exchange::kNone) {
    ++bad_replies_;  // nobody asked: the next reply may not be what it seems
    in_step_ = false;
  } else if (std::regex_match(reply, protocol_.refuse)) {
    giveUp("refused: " + reply);
  } else {
    complete(reply);
  }
}

void SerialInjector::complete(const std::string& reply) {
  if (exchange_ == Exchange::kPulse) {
    if (!std::regex_match(reply, protocol_.pulse.expect)) return giveUp("a wrong reply");
    model_.pulse(protocol_.asSent(*sent_pulse_));
    sent_pulse_.reset();
  } else if (exchange_ == Exchange::kBalance) {
    if (!std::regex_match(reply, protocol_.balance.expect)) return giveUp("a wrong reply");
    model_.setBalance(sent_balance_);
  } else if (exchange_ == Exchange::kStop) {
    if (!std::regex_match(reply, protocol_.stop->expect)) return giveUp("a wrong reply");
    model_.stop();
  } else {
    const auto pressure = protocol_.queriedPressure(reply);
    if (!pressure || !limits_.checkPressure("", *pressure).empty()) return giveUp("a wrong reply");
    pressure_ = pressure;
  }
  exchange_ = Exchange::kNone;
  tries_ = 0;
  trouble_.clear();
}

void SerialInjector::giveUp(const std::string& why) {
  const bool said_no = why.rfind("refused", 0) == 0;
  bad_replies_ += said_no ? 0 : 1;
  in_step_ = in_step_ && said_no;
  ++tries_;
  const Exchange given_up = std::exchange(exchange_, Exchange::kNone);
  if (given_up == Exchange::kPulse) {
    fail("pulse " + std::to_string(sent_pulse_->id) + ": " + why +
         (said_no ? "" : "; it may have been done, and is not sent again"));
    sent_pulse_.reset();
  } else if (given_up == Exchange::kBalance) {
    if (said_no || tries_ >= kTries) {
      fail("balance pressure: " + why);
    } else if (!waiting_balance_) {
      waiting_balance_ = sent_balance_;
    }
  } else if (given_up == Exchange::kStop) {
    if (said_no || tries_ >= kTries) {
      fail("stop: " + why + "; the pulse may go on");
    } else {
      waiting_stop_ = true;
    }
  } else if (given_up == Exchange::kQuery && tries_ >= kTries) {
    trouble_ = "query: " + why;
    pressure_.reset();
  }
}

void SerialInjector::fail(const std::string& why) {
  fault_ = why;
  if (waiting_pulse_) fault_ += "; pulse " + std::to_string(waiting_pulse_->id) + " was not sent";
  waiting_pulse_.reset();
}

void SerialInjector::talk(double time) {
  const double patience = protocol_.balance.timeout + protocol_.pulse.timeout + protocol_.quiet;
  if (waiting_pulse_ && time - waits_since_ > patience) fail("the line was not free in time");
  if (!in_step_ || exchange_ != Exchange::kNone) return;
  if (waiting_stop_) {
    waiting_stop_ = false;
    send(Exchange::kStop, protocol_.stop->send.fill({}), protocol_.stop->timeout, time);
  } else if (waiting_balance_) {  // before the pulse, which returns to it
    sent_balance_ = *waiting_balance_;
    waiting_balance_.reset();
    send(Exchange::kBalance, protocol_.balanceLine(sent_balance_), protocol_.balance.timeout, time);
  } else if (waiting_pulse_) {
    sent_pulse_ = std::exchange(waiting_pulse_, std::nullopt);
    send(Exchange::kPulse, protocol_.pulseLine(*sent_pulse_), protocol_.pulse.timeout, time);
  } else if (protocol_.query && time - asked_ >= protocol_.query_period) {
    asked_ = time;
    send(Exchange::kQuery, protocol_.query->send.fill({}), protocol_.query->timeout, time);
  }
}

void SerialInjector::send(Exchange exchange, const std::string& line, double timeout, double time) {
  exchange_ = exchange;
  deadline_ = time + timeout;
  wire_->write(line, time);
}

void SerialInjector::report() {
  reading_ = model_.reading();
  reading_.busy = reading_.busy || waiting_pulse_ || sent_pulse_ || waiting_stop_ || exchange_ == Exchange::kStop;
  if (pressure_) reading_.pressure = *pressure_;
}

}  // namespace microinjection
