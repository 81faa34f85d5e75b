"""Errors that are the user's to mend; the command line prints them without a traceback and exits with 2."""


class UserError(Exception):
    """Bad input; the message says what, where, the value got and what is allowed."""
