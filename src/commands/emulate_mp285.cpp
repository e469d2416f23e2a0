// An emulated mp285 on a pseudo-terminal; see --help.

#include "commands/emulate.h"

int main(int argc, char** argv) { return microinjection::emulate("mp285", argc, argv); }
