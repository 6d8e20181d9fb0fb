"""Continuation: drivers that move a contact from state to state, the branch that they pass, marks and error budget."""
