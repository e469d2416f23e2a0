#pragma once

#include <boost/program_options.hpp>
#include <functional>
#include <string>
#include <vector>

#include "base/exit_status.h"

namespace microinjection {

/// Reads a program's words and stores the values of its options. Where they ask for help, prints `help` and the
/// options.
/// @param words       without the program's name
/// @param positional  the option that takes words without a name; empty: there is none
/// @param most        of them; -1: any number
/// @param hidden      options that the help does not list, of calls by the program itself
/// @return whether the program shall go on: false after its help
/// @throws ConfigError for words that are no options or have wrong values
bool readCommandLine(const std::vector<std::string>& words, const boost::program_options::options_description& options,
                     const std::string& help, boost::program_options::variables_map& given,
                     const std::string& positional = "", int most = 1,
                     const boost::program_options::options_description& hidden = {});

/// The same without short options and without words, so that -1e-6 is a value.
bool readLongOptions(const std::vector<std::string>& words, const boost::program_options::options_description& options,
                     boost::program_options::variables_map& given);

/// argv without the program's name.
std::vector<std::string> wordsOf(int argc, char** argv);

/// The exit status of `run`. What it throws is printed, with the program's name before each line: a UserError is
/// kBadUsage, anything else `failed`.
int runProgram(const std::string& name, const std::function<int()>& run, int failed = kBadUsage);

}  // namespace microinjection
