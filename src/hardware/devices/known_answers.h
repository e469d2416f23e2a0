#pragma once

#include <string>

namespace microinjection {

/// What a serial port's other end is, by what it says: "a Zaber", "an Eppendorf", "a modem", ...; of something unknown
/// "something that says \"...\""; empty: it has said nothing. A guess for messages, from the forms of the answers
/// (doc/reference/devices.md): nothing is commanded by it.
std::string nameOfAnswer(const std::string& bytes);

}  // namespace microinjection
