//! Reading and saving case files.
