#include "harness/command/program.h"

int main(int argc, char** argv) { return assay::harness::program({argv + 1, argv + argc}); }
