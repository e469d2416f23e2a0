#include "commands/number_arguments.h"

#include <cmath>
#include <exception>
#include <limits>

#include "base/errors.h"
#include "base/separated.h"

namespace microinjection {

std::vector<double> parseNumbers(const std::string& option, const std::string& text, const std::string& wanted) {
  std::vector<double> numbers;
  for (const std::string& item : separated(text)) {
    std::size_t used = 0;
    double number = std::numeric_limits<double>::quiet_NaN();
    try {
      number = std::stod(item, &used);
    } catch (const std::exception&) {
      used = std::string::npos;
    }
    if (used != item.size() || !std::isfinite(number)) {
      throw ConfigError("--" + option + " = " + text + ": '" + item + "' is not a number; must be " + wanted);
    }
    numbers.push_back(number);
  }
  return numbers;
}

double parsePositive(const std::string& option, const std::string& text, const std::string& unit, bool zero) {
  const std::string wanted = std::string("a number ") + (zero ? ">= 0" : "> 0") + unit;
  const std::vector<double> numbers = parseNumbers(option, text, wanted);
  if (numbers.size() != 1 || numbers[0] < 0 || (!zero && numbers[0] == 0)) {
    throw ConfigError("--" + option + " = " + text + ": must be " + wanted);
  }
  return numbers[0];
}

}  // namespace microinjection
