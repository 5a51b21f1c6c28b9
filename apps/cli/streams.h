/// Standard output and error of a program that goes on when they are gone: closed, on a full disk,
/// a pipe that nobody reads. What a command computes does not depend on who listens.
#pragma once

namespace taut::cli {

/// To be called before anything is opened or printed. From then on printing never fails or throws.
void GuardStreams();

/// Says that what this command prints is about files that it writes: if it cannot be printed,
/// nothing that was asked for is lost.
void OutputIsNews();

/// Prints what is left. The status to end with: `exit_code`, or that of a failure if what was asked
/// for was to be printed and has not arrived.
int FinishOutput(int exit_code);

}  // namespace taut::cli
