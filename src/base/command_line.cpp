#include "base/command_line.h"

#include <iostream>
#include <sstream>

#include "base/errors.h"
#include "base/standard_output.h"

namespace microinjection {

namespace po = boost::program_options;

namespace {

bool read(po::command_line_parser& parser, const po::options_description& options, const std::string& help,
          po::variables_map& given, const po::options_description& hidden = {}) {
  try {
    po::options_description all;
    all.add(options).add(hidden);
    po::store(parser.options(all).run(), given);
    po::notify(given);
  } catch (const po::error& error) {
    throw ConfigError(std::string(error.what()) + "; see --help");
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
                     const std::string& help, po::variables_map& given, const std::string& positional, int most,
                     const po::options_description& hidden) {
  po::positional_options_description places;
  if (!positional.empty()) places.add(positional.c_str(), most);
  return read(po::command_line_parser(words).positional(places), options, help, given, hidden);
}

bool readLongOptions(const std::vector<std::string>& words, const po::options_description& options,
                     po::variables_map& given) {
  using Style = po::command_line_style::style_t;
  const int style = Style::allow_long | Style::long_allow_adjacent | Style::long_allow_next;
  return read(po::command_line_parser(words).style(style).positional({}), options, "", given);
}

std::vector<std::string> wordsOf(int argc, char** argv) { return {argv + 1, argv + argc}; }

int runProgram(const std::string& name, const std::function<int()>& run, int failed) {
  try {
    return run();
  } catch (const std::exception& error) {
    std::istringstream lines(error.what());
    for (std::string line; std::getline(lines, line);) std::cerr << name << ": " << line << '\n';
    return dynamic_cast<const UserError*>(&error) ? kBadUsage : failed;
  }
}

}  // namespace microinjection
