#include "base/command_line.h"

#include <iostream>
#include <sstream>

#include "base/errors.h"
#include "base/exit_status.h"
#include "base/standard_output.h"

namespace microinjection {

namespace po = boost::program_options;

namespace {

bool read(po::command_line_parser& parser, const po::options_description& options, const std::string& help,
          po::variables_map& given) {
  try {
    po::store(parser.run(), given);
    po::notify(given);
  } catch (const po::error& error) {
    throw ConfigError(error.what());
  }
  const bool asks = given.count("help") != 0;
  if (asks) {
    std::cout << help << options;
    flushStandardOutput();
  }
  return !asks;
}

}  // namespace

bool readCommandLine(const std::vector<std::string>& words, const po::options_description& options,
                     const std::string& help, po::variables_map& given, const std::string& positional, int most) {
  po::positional_options_description places;
  if (!positional.empty()) places.add(positional.c_str(), most);
  return read(po::command_line_parser(words).options(options).positional(places), options, help, given);
}

bool readLongOptions(const std::vector<std::string>& words, const po::options_description& options,
                     po::variables_map& given) {
  using Style = po::command_line_style::style_t;
  const int style = Style::allow_long | Style::long_allow_adjacent | Style::long_allow_next;
  return read(po::command_line_parser(words).options(options).style(style).positional({}), options, "", given);
}

std::vector<std::string> wordsOf(int argc, char** argv) { return {argv + 1, argv + argc}; }

int runProgram(const std::string& name, const std::function<int()>& run) {
  int status = kBadUsage;
  try {
    status = run();
  } catch (const std::exception& error) {
    std::istringstream lines(error.what());
    for (std::string line; std::getline(lines, line);) std::cerr << name << ": " << line << '\n';
  }
  return status;
}

}  // namespace microinjection
