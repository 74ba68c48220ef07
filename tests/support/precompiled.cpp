// Owns the precompiled header of the test programs: a library needs a source.
