#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace microinjection {

/// A table of numbers as instruments, spreadsheets and people write it: its columns, and what was found on the way.
struct TextTable {
  struct Column {
    std::string title;               ///< UTF-8, without the quotes and blanks around it; empty without titles
    std::string unit;                ///< of a line of units below the titles; else empty
    std::vector<double> values;      ///< one for each row; not a number where the cell is empty or a text
    std::size_t numbers = 0;         ///< cells that are numbers, or times of the day
    bool clock = false;              ///< of the day: the values are s since the first one
    std::vector<std::string> texts;  ///< cells that are neither empty nor numbers, else empty; none: there is no such
    std::string text;                ///< the first one of them
    std::size_t text_line = 0;       ///< its line
  };

  std::string path;
  std::vector<Column> columns;
  std::size_t title_line = 0;      ///< from 1; 0: the table has no titles
  std::size_t first_line = 0;      ///< of the first row
  std::string before;              ///< the last line before the first row that is no comment; empty: there is none
  std::vector<std::size_t> parts;  ///< first rows of further parts, where the titles are repeated
  std::vector<std::string> notes;  ///< what was taken for what where it is not plain, for the user

  std::size_t rows() const { return columns.empty() ? 0 : columns.front().values.size(); }
  std::vector<std::string> titles() const;
};

/// Reads a table: lines in UTF-8, UTF-16 or Latin-1, ended by LF, CR or CRLF, also compressed (gzip); cells between
/// commas, semicolons, tabs or blanks, and in quotes; a decimal point or comma, and separators of thousands; a preamble
/// and comments (#, %, //) before the titles, titles in the last comment or none; a line of units; times of the day and
/// dates; a line sep=X. A last line that was cut off is left out. Throws ConfigError that names file, line, what was
/// found and what is allowed: for rows with another number of cells, two decimal signs, NUL, and a file without a
/// table. `least_numbers`: by which a row is told from a text; 1 for a table of names with one number each.
TextTable readTextTable(const std::string& path, int least_numbers = 2);

}  // namespace microinjection
