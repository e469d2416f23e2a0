#pragma once

#include <boost/program_options.hpp>
#include <exception>
#include <iostream>
#include <string>

#include "base/atomic_file.h"

namespace microinjection {

/// The main of a benchmark program: `table` makes the CSV table, printing its rows as it goes;
/// --csv FILE stores it. `more`: options of its own.
template <typename Table>
int benchMain(int argc, char** argv, const std::string& title, const Table& table,
              const boost::program_options::options_description& more = {}) {
  namespace po = boost::program_options;
  try {
    std::string csv;
    po::options_description options(title + "\nPrints the table. Options");
    options.add_options()("help", "this text")("csv", po::value(&csv), "file to write the table to as well");
    options.add(more);
    po::variables_map values;
    // Without that boost takes what is no option for one and drops it.
    const po::positional_options_description none;
    po::store(po::command_line_parser(argc, argv).options(options).positional(none).run(), values);
    po::notify(values);
    if (values.count("help") != 0) {
      std::cout << options;
      return 0;
    }
    const std::string rows = table();
    if (!csv.empty()) writeFileAtomically(csv, rows);
    return 0;
  } catch (const std::exception& exception) {
    std::cerr << argv[0] << ": " << exception.what() << '\n';
    return 2;
  }
}

}  // namespace microinjection
