// Entry point of the program `taut`.
#include "command_main.h"

int main(int argc, char** argv) { return taut::cli::Main(argc, argv); }
