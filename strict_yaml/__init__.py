"""The one reader of all our YAML: every error says file:line:column, what it got and what is allowed."""
