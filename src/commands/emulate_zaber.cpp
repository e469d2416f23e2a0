// An emulated zaber on a pseudo-terminal; see --help.

#include "commands/emulate.h"

int main(int argc, char** argv) { return microinjection::emulate("zaber", argc, argv); }
