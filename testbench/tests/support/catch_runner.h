#pragma once

/// Runs the program's Catch2 cases, as its arguments ask. Returns the exit code.
int run_cases(int argc, char** argv);
