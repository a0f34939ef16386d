//! Annotations and images -> files.
